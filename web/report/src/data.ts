// SPDX-License-Identifier: GPL-3.0-or-later
// The data that the program writes into the page (src/io/results/report/report_data.cpp).
import type { HoleMap } from '../../shared/hole_map';
import { parseWritten } from '../../shared/written';

export interface EventMark {
  kind: string;
  label: string;
  time_s: number;
  depth_mm: number;
  force_N: number;
}

export interface Steps {
  time_s: Float32Array;
  depth_mm: Float32Array;  // base depth
  axial_N: Float32Array;
  sagittal_N: Float32Array;
  lateral_N: Float32Array;
}

/** Mean shift of the gland after each step. */
export interface GlandPath {
  LR_mm: Float32Array;  // positive to the patient's left
  AP_mm: Float32Array;  // positive to posterior
  SI_mm: Float32Array;  // positive to superior
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
  time_s: number;
  depth_mm: number;
  label: string;
  displacement: Int16Array;  // (3 × surface nodes) × displacement_scale_mm = [mm]
  needle_mm: Float32Array;   // (3 × points) LPS, base to tip
  contacts: Float32Array;    // (4 × contacts): x y z [mm] LPS, state 0 slipping, 1 sticking, 2 tip
}

export interface ReportData {
  map: HoleMap | null;      // map of the template's holes
  steps: Steps;
  gland: GlandPath | null;  // null: there is no gland
  events: EventMark[];
  histogram: { edges_us: number[]; counts: number[] };
  surface: { points_mm: Float32Array; regions: Region[] };  // (3 × surface nodes) LPS, undeformed
  displacement_scale_mm: number;  // per unit of Frame.displacement
  displacement_max_mm: number;    // largest displacement in any frame
  frames: Frame[];
  first_frame: number;            // index of the frame to show first
  needle_diameter_mm: number;
  entry_mm: [number, number, number];
  direction: [number, number, number];
}

export function decode(json: string): ReportData {
  const floats = ['time_s', 'depth_mm', 'axial_N', 'sagittal_N', 'lateral_N', 'LR_mm', 'AP_mm', 'SI_mm', 'points_mm', 'needle_mm', 'contacts'];
  return parseWritten(json, { ...Object.fromEntries(floats.map((key) => [key, Float32Array])), displacement: Int16Array, triangles: Uint32Array });
}

/** Index of the step that is nearest in time. Times are in ascending order. */
export function nearestStep(steps: Steps, time: number): number {
  let low = 0;
  let high = steps.time_s.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (steps.time_s[middle] < time) low = middle;
    else high = middle;
  }
  return time - steps.time_s[low] < steps.time_s[high] - time ? low : high;
}

/** Index of the step with the largest depth, at which the way back starts. */
export function turningStep(steps: Steps): number {
  let deepest = 0;
  for (let i = 1; i < steps.depth_mm.length; i++) if (steps.depth_mm[i] >= steps.depth_mm[deepest]) deepest = i;
  return deepest;
}
