// SPDX-License-Identifier: GPL-3.0-or-later
// The data that the program writes into the page (src/io/results/report/report_data.cpp), and their decoded form.
import type { HoleMap } from '../../shared/hole_map';

/** The data as written; arrays are little-endian numbers in base64. */
type Base64 = string;

interface RawData {
  map: HoleMap | null;
  steps: { count: number; time_s: Base64; depth_mm: Base64; axial_N: Base64; sagittal_N: Base64; lateral_N: Base64 };
  gland: { LR_mm: Base64; AP_mm: Base64; SI_mm: Base64 } | null;
  events: EventMark[];
  histogram: { edges_us: number[]; counts: number[] };
  surface: { points_mm: Base64; regions: RawRegion[] };
  displacement_scale_mm: number;
  displacement_max_mm: number;
  frames: {
    time_s: number; depth_mm: number; label: string; displacement: Base64; needle_mm: Base64; contacts: Base64;
  }[];
  first_frame: number;
  needle_diameter_mm: number;
  entry_mm: [number, number, number];
  direction: [number, number, number];
}

interface RawRegion {
  name: string; label: string; color: string; opacity: number; target: boolean; background: boolean; triangles: Base64;
}

export interface EventMark {
  kind: string;
  label: string;
  time_s: number;
  depth_mm: number;
  force_N: number;
}

export interface Steps {
  time: Float32Array;      // [s]
  depth: Float32Array;     // [mm] base depth
  axial: Float32Array;     // [N]
  sagittal: Float32Array;  // [N]
  lateral: Float32Array;   // [N]
}

/** Mean shift of the gland after each step [mm]; null if there is no gland. */
export interface GlandPath {
  lr: Float32Array;  // positive to the patient's left
  ap: Float32Array;  // positive to posterior
  si: Float32Array;  // positive to superior
}

export interface Region {
  name: string;
  label: string;
  color: string;
  opacity: number;
  target: boolean;
  background: boolean;
  triangles: Uint32Array;  // (3 × triangles) indices of surface nodes, outward normals
}

export interface Frame {
  time: number;               // [s]
  depth: number;              // [mm]
  label: string;
  displacement: Int16Array;   // (3 × surface nodes) × displacementScale = [mm]
  needle: Float32Array;       // (3 × points) [mm] LPS, base to tip
  contacts: Float32Array;     // (4 × contacts): x y z [mm] LPS, state 0 slipping, 1 sticking, 2 tip
}

export interface ReportData {
  map: HoleMap | null;        // map of the template's holes
  steps: Steps;
  gland: GlandPath | null;
  events: EventMark[];
  histogram: { edges_us: number[]; counts: number[] };
  points: Float32Array;       // (3 × surface nodes) [mm] LPS, undeformed
  regions: Region[];
  displacementScale: number;  // [mm] per unit of Frame.displacement
  displacementMax: number;    // [mm] largest displacement in any frame
  frames: Frame[];
  firstFrame: number;         // index of the frame to show first
  needleDiameter: number;     // [mm]
  entry: [number, number, number];
  direction: [number, number, number];
}

function bytes(text: Base64): ArrayBuffer {
  const binary = atob(text);
  const array = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) array[i] = binary.charCodeAt(i);
  return array.buffer;
}

export function decode(json: string): ReportData {
  const raw = JSON.parse(json) as RawData;
  const floats = (text: Base64) => new Float32Array(bytes(text));
  return {
    steps: {
      time: floats(raw.steps.time_s),
      depth: floats(raw.steps.depth_mm),
      axial: floats(raw.steps.axial_N),
      sagittal: floats(raw.steps.sagittal_N),
      lateral: floats(raw.steps.lateral_N),
    },
    gland: raw.gland && { lr: floats(raw.gland.LR_mm), ap: floats(raw.gland.AP_mm), si: floats(raw.gland.SI_mm) },
    map: raw.map,
    events: raw.events,
    histogram: raw.histogram,
    points: floats(raw.surface.points_mm),
    regions: raw.surface.regions.map((r) => ({ ...r, triangles: new Uint32Array(bytes(r.triangles)) })),
    displacementScale: raw.displacement_scale_mm,
    displacementMax: raw.displacement_max_mm,
    frames: raw.frames.map((f) => ({
      time: f.time_s,
      depth: f.depth_mm,
      label: f.label,
      displacement: new Int16Array(bytes(f.displacement)),
      needle: floats(f.needle_mm),
      contacts: floats(f.contacts),
    })),
    firstFrame: raw.first_frame,
    needleDiameter: raw.needle_diameter_mm,
    entry: raw.entry_mm,
    direction: raw.direction,
  };
}

/** Index of the step that is nearest in time. Times are in ascending order. */
export function nearestStep(steps: Steps, time: number): number {
  let low = 0;
  let high = steps.time.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (steps.time[middle] < time) low = middle;
    else high = middle;
  }
  return time - steps.time[low] < steps.time[high] - time ? low : high;
}

/** Index of the step with the largest depth, at which the way back starts. */
export function turningStep(steps: Steps): number {
  let deepest = 0;
  for (let i = 1; i < steps.depth.length; i++) if (steps.depth[i] >= steps.depth[deepest]) deepest = i;
  return deepest;
}
