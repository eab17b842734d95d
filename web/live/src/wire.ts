// SPDX-License-Identifier: GPL-3.0-or-later
// Encodes and decodes the messages of docs/live_protocol.md. Decoding checks every length before it reads; a WireError
// says what is wrong.
import type { HoleMap } from '../../shared/hole_map';
import type { Command } from './commands';
import type { LiveImage, ImageText, ShownImage } from './imaging/image';
import type { Dose, Implant, Plan, Seeds } from './implant/implant';
import type { Scene, SceneText } from './scene';

export const SUBPROTOCOL = 'stylet-live-4';
export const PROTOCOL = 4;

export const enum Kind { scene = 1, frame = 2, status = 3, event = 4, notice = 5, map = 6, plan = 7, implant = 8, seeds = 9, dose = 10, image = 11, hand = 16, command = 17, seen = 18 }
export const TIP_STATES = ['in air', 'pressing', 'cutting', 'in its track', 'on bone', 'through'] as const;
export const SAMPLE_WORDS = 8;  // time, depth, axial, sagittal, lateral force, CPU time [µs], tip state, flags

/** The state at one moment. Vectors are in LPS, in [mm] or [N], and are views into the message. */
export interface Frame {
  time: number;              // [s] simulated time
  paused: boolean;
  replayed: boolean;
  trusted: boolean;          // the force can be trusted
  shown: boolean;            // the frame has a displacement
  whole: boolean;            // the samples are the whole curve and replace all earlier ones
  approximate: boolean;      // compliance is missing, so the force is approximate
  unfelt: boolean;           // the tip is in the tissue, but no force acts on the needle
  flags: number;
  tipState: number;
  sticking: number;
  iterations: number;
  steps: number;
  missed: number;            // missed deadlines so far
  depth: number;             // [mm] base depth
  force: Float32Array;       // [N] axial, sagittal, lateral
  torque: Float32Array;      // [N·mm] LPS
  tip: Float32Array;
  base: Float32Array;
  orientation: Float32Array; // w x y z
  hand: Float32Array;        // [degrees] roll, tilt to the left, tilt to anterior
  hidden: number;            // [N] force whose displacement is not shown
  unit: number;              // [mm] per unit of displacement
  tipError: Float32Array;    // [mm] LPS, tip error at the deepest step so far; NaN: the tip is not in the tissue
  tipErrorDepth: number;     // [mm] base depth in that step
  line: Float32Array;        // (3 × points) base to tip
  resting: Float32Array[];   // (needles at rest) of (3 × points) base to tip
  contacts: Float32Array;    // (4 × contacts) x y z, state 0 slipping, 1 sticking, 2 tip
  contactForces: Float32Array;  // (3 × contacts) forces on the tissue
  samples: Float32Array;     // (8 × steps) times are relative to the frame's
  displacement: Int16Array;  // (3 × nodes of the scene), or empty
}

export interface Status {
  state: 'loading' | 'ready' | 'failed';
  stage?: string; fraction?: number | null; message?: string; cure?: string;
  mode?: 'live' | 'replay'; paused?: boolean; insertion?: string; hole?: string; inside?: string[]; seed_off_mm?: number | null;
  you_hold?: boolean; hand_stopped?: boolean; held?: boolean; asking?: number; you_ask?: boolean; viewers?: number; device?: string; device_problem?: string;
  companion?: { name: string; not_used: number; newest: string; cure: string };
  recording?: { name: string; seconds: number; problem?: string; warning?: string } | null;
  replay?: { name: string; time_s: number; duration_s: number; playing: boolean; rate: number } | null;
  interrupted?: Interrupted | null;  // an implant of the open case that was begun and not finished
  image?: { shown: ShownImage; problem: string; stage: string; probe_device?: string; probe_problem?: string };
  loop?: { steps: number; missed: number; p50_us: number; p99_us: number; max_us: number; rights?: string } | null;
  lag_s?: number | null; dropped_messages?: number; skipped_frames?: number;
}

export interface Interrupted { recording: string; recorded_s: number; seeds: number; planned_seeds: number; needle: string }
/** `label` says it in words; it is empty for an event that another one of the same moment has said. */
export interface Event { kind: string; time_s: number; depth_mm: number; force_N: number; region: string; label: string }
export interface LiveMap { map: HoleMap | null; why_not: string; predicted: number; predicting: boolean }
export interface Notice { text: string; cure: string }

export interface Hand { depth: number; speed: number; roll: number; tiltLeft: number; tiltAnterior: number }

export type Message =
  | { kind: Kind.scene; scene: Scene } | { kind: Kind.frame; frame: Frame } | { kind: Kind.status; status: Status }
  | { kind: Kind.event; event: Event } | { kind: Kind.notice; notice: Notice }
  | { kind: Kind.map; map: LiveMap } | { kind: Kind.plan; plan: Plan } | { kind: Kind.implant; implant: Implant }
  | { kind: Kind.seeds; seeds: Seeds } | { kind: Kind.dose; dose: Dose }
  | { kind: Kind.image; image: LiveImage };

export class WireError extends Error {}

const COMPLIANCE_MISSING = 1 << 2;  // as in Step::Flag
const NO_CONTACT_INSIDE = 1 << 6;
const HEADER = 8;
const FRAME_HEADER = 168;
const DOSE_HEADER = HEADER + 32;
const IMAGE_HEADER = HEADER + 12;
const RESTING_POINTS = 17;  // of each needle at rest
const LIMITS = { points: 4096, resting: 64, contacts: 8192, samples: 4096, nodes: 4_000_000, triangles: 8_000_000, dose: 1_000_000, pixels: 16_000_000 };

function must(holds: boolean, what: string): asserts holds {
  if (!holds) throw new WireError(what);
}

function json(buffer: ArrayBuffer, from: number, length: number): unknown {
  try {
    return JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(new Uint8Array(buffer, from, length)));
  } catch {
    throw new WireError('a text that is not JSON');
  }
}

function decodeScene(buffer: ArrayBuffer, view: DataView): Scene {
  must(buffer.byteLength >= HEADER + 12, 'a scene without its header');
  const bytes = view.getUint32(8, true);
  const nodes = view.getUint32(12, true);
  const triangles = view.getUint32(16, true);
  must(nodes <= LIMITS.nodes && triangles <= LIMITS.triangles, `a scene of ${nodes} nodes and ${triangles} triangles`);
  must(bytes % 4 === 0 && buffer.byteLength === 20 + bytes + 12 * nodes + 12 * triangles, 'a scene of the wrong length');
  const text = json(buffer, 20, bytes) as SceneText;
  must(text.protocol === PROTOCOL, `a scene of protocol ${text.protocol}; this page speaks ${PROTOCOL}`);
  const points = new Float32Array(buffer, 20 + bytes, 3 * nodes);
  const corners = new Uint32Array(buffer, 20 + bytes + 12 * nodes, 3 * triangles);
  must(corners.every((c) => c < nodes), 'a triangle whose corner does not exist');
  must(points.every(Number.isFinite), 'a position that is not a number');
  for (const patch of text.patches) {
    must(patch.first >= 0 && patch.count >= 0 && patch.first + patch.count <= triangles, 'a patch beyond the last triangle');
    must(patch.inside >= 0 && patch.inside < text.regions.length && patch.outside < text.regions.length, 'a patch of no region');
  }
  return { ...text, points, corners };
}

function decodeFrame(buffer: ArrayBuffer, view: DataView): Frame {
  must(buffer.byteLength >= FRAME_HEADER, 'a frame without its header');
  const u = (word: number) => view.getUint32(16 + 4 * word, true);
  const floats = (offset: number, count: number) => new Float32Array(buffer, offset, count);
  const bits = u(0);
  const [p, c, s, n, q] = [148, 152, 156, 160, 164].map((offset) => view.getUint32(offset, true));
  must(p <= LIMITS.points && c <= LIMITS.contacts && s <= LIMITS.samples && n <= LIMITS.nodes && q <= LIMITS.resting, 'a frame of impossible size');
  const atResting = FRAME_HEADER + 12 * p;
  const ofResting = 12 * RESTING_POINTS;
  const atContacts = atResting + ofResting * q;
  const atSamples = atContacts + 32 * c;
  const atNodes = atSamples + 4 * SAMPLE_WORDS * s;
  const coarse = (bits & 32) !== 0;
  must(buffer.byteLength === atNodes + (coarse ? 3 : 6) * n, 'a frame of the wrong length');
  const contacts = new Float32Array(4 * c);
  const contactForces = new Float32Array(3 * c);
  const raw = floats(atContacts, 8 * c);
  for (let i = 0; i < c; i++) {
    const state = view.getUint32(atContacts + 32 * i + 28, true);
    for (let k = 0; k < 3; k++) {
      contacts[4 * i + k] = raw[8 * i + k];
      contactForces[3 * i + k] = raw[8 * i + 3 + k];
    }
    contacts[4 * i + 3] = state & 2 ? 2 : state & 1;
  }
  return {
    time: view.getFloat64(8, true),
    paused: (bits & 1) !== 0, replayed: (bits & 2) !== 0, trusted: (bits & 4) !== 0, shown: (bits & 8) !== 0, whole: (bits & 16) !== 0,
    approximate: (u(1) & COMPLIANCE_MISSING) !== 0, unfelt: (u(1) & NO_CONTACT_INSIDE) !== 0, flags: u(1), tipState: u(2), sticking: u(3), iterations: u(4), steps: u(5), missed: u(6),
    depth: view.getFloat32(44, true),
    force: floats(48, 3), torque: floats(60, 3), tip: floats(72, 3), base: floats(84, 3), orientation: floats(96, 4), hand: floats(112, 3),
    hidden: view.getFloat32(124, true), unit: view.getFloat32(128, true),
    tipError: floats(132, 3), tipErrorDepth: view.getFloat32(144, true),
    line: floats(FRAME_HEADER, 3 * p),
    resting: Array.from({ length: q }, (_, i) => floats(atResting + ofResting * i, 3 * RESTING_POINTS)),
    contacts, contactForces,
    samples: floats(atSamples, SAMPLE_WORDS * s),
    displacement: coarse ? Int16Array.from(new Int8Array(buffer, atNodes, 3 * n)) : new Int16Array(buffer, atNodes, 3 * n),
  };
}

function decodeDose(buffer: ArrayBuffer, view: DataView): Dose {
  must(buffer.byteLength >= DOSE_HEADER, 'a dose without its header');
  const size = [0, 1, 2].map((i) => view.getUint32(HEADER + 4 * i, true)) as [number, number, number];
  const points = size[0] * size[1] * size[2];
  must(points <= LIMITS.dose && buffer.byteLength === DOSE_HEADER + 2 * points, 'a dose of the wrong length');
  const [x, y, z, spacing, unit] = new Float32Array(buffer, HEADER + 12, 5);
  must([x, y, z].every(Number.isFinite) && spacing > 0 && unit > 0, 'a dose at an impossible place');
  return { size, origin: [x, y, z], spacing, unit, values: new Uint16Array(buffer, DOSE_HEADER, points) };
}

function decodeImage(buffer: ArrayBuffer, view: DataView): LiveImage {
  must(buffer.byteLength >= IMAGE_HEADER, 'a picture without its header');
  const [bytes, rows, columns] = [0, 4, 8].map((offset) => view.getUint32(HEADER + offset, true));
  must(rows * columns <= LIMITS.pixels && buffer.byteLength === IMAGE_HEADER + bytes + rows * columns, 'a picture of the wrong length');
  const text = json(buffer, IMAGE_HEADER, bytes) as ImageText;
  return { ...text, rows, columns, pixels: new Uint8Array(buffer, IMAGE_HEADER + bytes, rows * columns) };
}

/** Decodes a message; null for an unknown kind. Throws a WireError if the message is malformed. */
export function decode(buffer: ArrayBuffer): Message | null {
  must(buffer.byteLength >= HEADER, 'a message without its header');
  const view = new DataView(buffer);
  const rest = () => json(buffer, HEADER, buffer.byteLength - HEADER);
  switch (view.getUint32(0, true)) {
    case Kind.scene: return { kind: Kind.scene, scene: decodeScene(buffer, view) };
    case Kind.frame: return { kind: Kind.frame, frame: decodeFrame(buffer, view) };
    case Kind.status: return { kind: Kind.status, status: rest() as Status };
    case Kind.event: return { kind: Kind.event, event: rest() as Event };
    case Kind.notice: return { kind: Kind.notice, notice: rest() as Notice };
    case Kind.plan: return { kind: Kind.plan, plan: rest() as Plan };
    case Kind.implant: return { kind: Kind.implant, implant: rest() as Implant };
    case Kind.seeds: return { kind: Kind.seeds, seeds: rest() as Seeds };
    case Kind.dose: return { kind: Kind.dose, dose: decodeDose(buffer, view) };
    case Kind.image: return { kind: Kind.image, image: decodeImage(buffer, view) };
    case Kind.map: return { kind: Kind.map, map: rest() as LiveMap };
    default: return null;
  }
}

export function encodeHand(hand: Hand): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(HEADER + 20));
  view.setUint32(0, Kind.hand, true);
  [hand.depth, hand.speed, hand.roll, hand.tiltLeft, hand.tiltAnterior].forEach((value, i) => view.setFloat32(HEADER + 4 * i, value, true));
  return view.buffer as ArrayBuffer;
}

/** The number of a message of the server; 0 if it has no header. */
export function numberOf(buffer: ArrayBuffer): number {
  return buffer.byteLength >= HEADER ? new DataView(buffer).getUint32(4, true) : 0;
}

/** @param number of the newest message that the page has taken up */
export function encodeSeen(number: number): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(HEADER + 4));
  view.setUint32(0, Kind.seen, true);
  view.setUint32(HEADER, number, true);
  return view.buffer as ArrayBuffer;
}

export function encodeCommand(command: Command): ArrayBuffer {
  const text = new TextEncoder().encode(JSON.stringify(command));
  const buffer = new ArrayBuffer(HEADER + text.length);
  new DataView(buffer).setUint32(0, Kind.command, true);
  new Uint8Array(buffer, HEADER).set(text);
  return buffer;
}
