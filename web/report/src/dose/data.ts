// SPDX-License-Identifier: GPL-3.0-or-later
// The data that the program writes into the page of stylet dose (src/io/results/dose/page_data.cpp). Grids, which are
// written in several ways, are converted.
import type { Grid } from '../../../shared/grid_slice';
import { parseWritten } from '../../../shared/written';

export type Triple = [number, number, number];

export interface Level {
  dose_Gy: number;
  label: string;
  color: string;
  main: boolean;  // the prescribed dose
}

export interface Structure {
  name: string;
  region: string;
  color: string;
  background: boolean;          // surrounds the others
  mask: Grid | null;            // 0 … 1: share of each cube that lies within
  surface: { points_mm: Float32Array; triangles: Uint32Array } | null;  // LPS
  contours_mm: Float32Array[];  // (3 × corners each) LPS
  cloud_mm: Float32Array;       // (3 × points) LPS, of a structure without mask
}

export interface Sources {
  temporary: boolean;
  length_mm: number;        // of the capsule
  diameter_mm: number;
  places_mm: Float32Array;  // (3 × sources) LPS
  axes: Float32Array;       // (3 × sources)
  needles: string[];        // of each source
  dwell_s: number[];
}

/** Computed dose minus that of a file. */
export interface Difference {
  grid: Grid;  // 0: not known; 1 … 255: −limit_Gy … limit_Gy
  limit_Gy: number;
}

export interface DoseData {
  prescription_Gy: number | null;
  dvh: { dose_Gy: number[]; percent: number[][] };
  centre_mm: Triple;  // LPS
  half_mm: number;    // half the edge of the cube that the sections show
  levels: Level[];
  dose: Grid;
  difference: Difference | null;
  structures: Structure[];
  sources: Sources;
}

interface WrittenGrid { size: Triple; origin_mm: Triple; spacing_mm: number }

interface WrittenData extends Omit<DoseData, 'dose' | 'difference' | 'structures'> {
  dose: WrittenGrid & { scale_Gy: number; values: Uint8Array };
  difference: (WrittenGrid & { limit_Gy: number; values: Uint8Array }) | null;
  structures: (Omit<Structure, 'mask'> & { mask: (WrittenGrid & { share: Uint8Array }) | null })[];
}

function gridOf({ size, origin_mm: origin, spacing_mm: spacing }: WrittenGrid, scale: number, values: ArrayLike<number>): Grid {
  return { size, origin, spacing, scale, values };
}

export function decode(json: string): DoseData {
  const { dose, difference, structures, ...rest } = parseWritten<WrittenData>(json, {
    values: Uint8Array, share: Uint8Array, points_mm: Float32Array, triangles: Uint32Array, contours_mm: Float32Array,
    cloud_mm: Float32Array, places_mm: Float32Array, axes: Float32Array,
  });
  return {
    ...rest,
    dose: gridOf(dose, dose.scale_Gy, new Uint16Array(dose.values.buffer)),
    difference: difference && { limit_Gy: difference.limit_Gy, grid: gridOf(difference, 1, difference.values) },
    structures: structures.map((one) => ({ ...one, mask: one.mask && gridOf(one.mask, 1 / 255, one.mask.share) })),
  };
}
