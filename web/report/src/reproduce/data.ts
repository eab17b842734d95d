// SPDX-License-Identifier: GPL-3.0-or-later
// The data that the program writes into the page (reproduction_data.cpp, reproduce_page.cpp).
import { parseWritten } from '../../../shared/written';

export interface Figure5Row {
  dim: number;
  inverse_s: number;
  bcs_s: number;
  woodbury_s: number;
  woodbury_symmetric_s: number;
}

export interface RunEvent {
  kind: string;
  region: string;
  label: string;
  iteration: number;
  time_s: number;
  depth_mm: number;
  force_N: number;
}

export interface Remeshing {
  kind: 'added_inside' | 'added_on_face' | 'repositioned';
  iteration: number;
  dimension: number;
  step_us: number;
}

export interface Curves {
  cumulative_s: Float32Array;
  axial_N: Float32Array;
  sagittal_N: Float32Array;
  lateral_N: Float32Array;
}

export interface Run {
  id: string;
  label: string;
  iterations: number;
  events: RunEvent[];
  remeshings: Remeshing[];
  curves: Curves;
}

export type Point = [number, number, number];  // [mm]

export interface Segment {
  points_mm: Point[];
  tets: [number, number, number, number][];
}

export interface Figure2 {
  contours: { points_mm: Point[]; kept: boolean[] }[];
  surface: { points_mm: Point[]; triangles: [number, number, number][] };
  needle_segment: { symmetric: Segment; asymmetric: Segment };
}

export interface ReproductionData {
  fig2: Figure2;
  fig5: Figure5Row[];
  runs: Run[];
}

export function decode(json: string): ReproductionData {
  return parseWritten(json, { cumulative_s: Float32Array, axial_N: Float32Array, sagittal_N: Float32Array, lateral_N: Float32Array });
}
