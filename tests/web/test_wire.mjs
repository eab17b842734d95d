// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { encodeFrame, encodeScene, encodeText } from './encode';
import { makePatient } from './made_up_patient';
import { decode, encodeCommand, encodeHand, WireError } from 'live/src/wire';

const f32 = (...values) => Float32Array.of(...values);

function frame() {
  return {
    time: 12.345678901, paused: true, replayed: false, trusted: true, shown: true, whole: true, approximate: true, unfelt: false, flags: 6, tipState: 2, sticking: 3,
    iterations: 4, steps: 70000, missed: 5, depth: 31.5, force: f32(1, 2, 3), torque: f32(4, 5, 6), tip: f32(7, 8, 9), base: f32(10, 11, 12),
    orientation: f32(1, 0, 0, 0.5), hand: f32(15, -2, 3), hidden: 0.25, unit: 0.5, tipError: f32(-0.5, 0.25, -3.5), tipErrorDepth: 31.5, line: f32(0, 0, 0, 0, 0, 100), resting: [1, 2].map((at) => new Float32Array(51).fill(at)),
    contacts: f32(1, 2, 3, 0, 4, 5, 6, 1, 7, 8, 9, 2), contactForces: f32(0, 0, 1, 0, 0, 2, 0, 0, 3),
    samples: f32(-0.001, 31, 1, 2, 3, 40, 2, 0, 0, 31.5, 1.5, 2, 3, 41, 2, 0), displacement: Int16Array.of(1, -2, 3),
  };
}

test('a frame comes out as it went in', () => {
  const message = decode(encodeFrame(frame()));
  assert.equal(message.kind, 2);
  assert.deepEqual(message.frame, frame());
});

test('a coarse displacement has a byte for each number', () => {
  const fine = encodeFrame(frame());
  const coarse = new Uint8Array(fine.slice(0, fine.byteLength - 3));
  new DataView(coarse.buffer).setUint32(16, new DataView(fine).getUint32(16, true) | 32, true);
  coarse.set([1, 256 - 2, 3], coarse.length - 3);
  assert.deepEqual(decode(coarse.buffer).frame, frame());
  assert.throws(() => decode(coarse.buffer.slice(0, coarse.length - 1)), WireError);
});

test('a frame that lacks a byte or has one too many is refused', () => {
  const buffer = encodeFrame(frame());
  assert.throws(() => decode(buffer.slice(0, buffer.byteLength - 1)), WireError);
  const longer = new Uint8Array(buffer.byteLength + 1);
  longer.set(new Uint8Array(buffer));
  assert.throws(() => decode(longer.buffer), WireError);
});

test('every shortened frame is refused, none is read beyond its end', () => {
  const buffer = encodeFrame(frame());
  for (let length = 0; length < buffer.byteLength; length++) assert.throws(() => decode(buffer.slice(0, length)), WireError);
});

test('counts that the message cannot hold are refused', () => {
  for (const offset of [148, 152, 156, 160, 164]) {
    const buffer = encodeFrame(frame());
    new DataView(buffer).setUint32(offset, 0xffffffff, true);
    assert.throws(() => decode(buffer), WireError);
  }
});

test('a scene comes out as it went in', () => {
  const patient = makePatient();
  const { scene } = decode(encodeScene(patient));
  assert.deepEqual(scene.points, patient.points);
  assert.deepEqual(scene.corners, patient.corners);
  assert.equal(scene.regions[1].label, 'Prostate');
});

test('a scene with a triangle of a node that does not exist is refused', () => {
  const patient = makePatient();
  patient.corners[7] = patient.points.length / 3;
  assert.throws(() => decode(encodeScene(patient)), WireError);
});

test('a scene with a patch beyond the triangles, of no region or of another protocol is refused', () => {
  for (const spoil of [(t) => (t.patches[0].count += 1e6), (t) => (t.patches[0].inside = 99), (t) => (t.protocol = 1)]) {
    const patient = makePatient();
    spoil(patient.text);
    assert.throws(() => decode(encodeScene(patient)), WireError);
  }
});

test('texts come out as they went in, and what is no JSON is refused', () => {
  const event = { kind: 'puncture', time_s: 1.5, depth_mm: 31, force_N: 2, region: 'prostate' };
  assert.deepEqual(decode(encodeText(4, event)).event, event);
  const buffer = encodeText(3, { state: 'ready' });
  new Uint8Array(buffer)[8] = 0xff;
  assert.throws(() => decode(buffer), WireError);
});

test('a map of the template comes out as it went in', () => {
  const map = { map: null, why_not: 'there is no gland', predicted: 0, predicting: false };
  assert.deepEqual(decode(encodeText(6, map)), { kind: 6, map });
});

test('a kind that is not known is ignored', () => {
  assert.equal(decode(encodeText(99, {})), null);
});

test('the hand is five numbers behind the header, in the order of the protocol', () => {
  const buffer = encodeHand({ depth: 31.5, speed: 20, roll: 15, tiltLeft: -2, tiltAnterior: 3 });
  const view = new DataView(buffer);
  assert.equal(buffer.byteLength, 28);
  assert.equal(view.getUint32(0, true), 16);
  assert.deepEqual([8, 12, 16, 20, 24].map((at) => view.getFloat32(at, true)), [31.5, 20, 15, -2, 3]);
});

test('a command is JSON behind the header', () => {
  const buffer = encodeCommand({ do: 'hole', hole: 'D4' });
  assert.equal(new DataView(buffer).getUint32(0, true), 17);
  assert.deepEqual(JSON.parse(new TextDecoder().decode(buffer.slice(8))), { do: 'hole', hole: 'D4' });
});
