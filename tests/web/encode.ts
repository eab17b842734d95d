// SPDX-License-Identifier: GPL-3.0-or-later
// The server's half of the protocol, for tests.
import { SAMPLE_WORDS, type Frame } from 'live/src/wire';
import type { MadeUpPatient } from './made_up_patient';

const FRAME_HEADER = 168;

export function encodeText(kind: number, what: unknown): ArrayBuffer {
  const text = new TextEncoder().encode(JSON.stringify(what));
  const buffer = new ArrayBuffer(8 + text.length);
  new DataView(buffer).setUint32(0, kind, true);
  new Uint8Array(buffer, 8).set(text);
  return buffer;
}

export function encodeScene({ text, points, corners }: MadeUpPatient): ArrayBuffer {
  let words = JSON.stringify(text);
  while (new TextEncoder().encode(words).length % 4 !== 0) words += ' ';
  const bytes = new TextEncoder().encode(words);
  const buffer = new ArrayBuffer(20 + bytes.length + 4 * points.length + 4 * corners.length);
  const view = new DataView(buffer);
  [1, 0, bytes.length, points.length / 3, corners.length / 3].forEach((v, i) => view.setUint32(4 * i, v, true));
  new Uint8Array(buffer, 20).set(bytes);
  new Float32Array(buffer, 20 + bytes.length, points.length).set(points);
  new Uint32Array(buffer, 20 + bytes.length + 4 * points.length).set(corners);
  return buffer;
}

/** `contacts` (4 × contacts) as the page has them decoded. */
export function encodeFrame(f: Frame): ArrayBuffer {
  const [p, c, s, n, q] = [f.line.length / 3, f.contacts.length / 4, f.samples.length / SAMPLE_WORDS, f.displacement.length / 3, f.resting.length];
  const atContacts = FRAME_HEADER + 12 * p + 12 * 17 * q;
  const buffer = new ArrayBuffer(atContacts + 32 * c + 32 * s + 6 * n);
  const view = new DataView(buffer);
  view.setUint32(0, 2, true);
  view.setFloat64(8, f.time, true);
  const bits = [f.paused, f.replayed, f.trusted, f.shown, f.whole].reduce((sum, bit, i) => sum + (bit ? 1 << i : 0), 0);
  [bits, f.flags, f.tipState, f.sticking, f.iterations, f.steps, f.missed].forEach((v, i) => view.setUint32(16 + 4 * i, v, true));
  const floats = [f.depth, ...f.force, ...f.torque, ...f.tip, ...f.base, ...f.orientation, ...f.hand, f.hidden, f.unit, ...f.tipError, f.tipErrorDepth];
  floats.forEach((v, i) => view.setFloat32(44 + 4 * i, v, true));
  [p, c, s, n, q].forEach((v, i) => view.setUint32(148 + 4 * i, v, true));
  new Float32Array(buffer, FRAME_HEADER, 3 * p).set(f.line);
  f.resting.forEach((line, i) => new Float32Array(buffer, FRAME_HEADER + 12 * (p + 17 * i), line.length).set(line));
  for (let i = 0; i < c; i++) {
    const at = atContacts + 32 * i;
    for (let k = 0; k < 3; k++) {
      view.setFloat32(at + 4 * k, f.contacts[4 * i + k], true);
      view.setFloat32(at + 12 + 4 * k, f.contactForces[3 * i + k], true);
    }
    view.setUint32(at + 28, f.contacts[4 * i + 3], true);
  }
  new Float32Array(buffer, atContacts + 32 * c, 8 * s).set(f.samples);
  new Int16Array(buffer, atContacts + 32 * c + 32 * s, 3 * n).set(f.displacement);
  return buffer;
}
