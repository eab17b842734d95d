// SPDX-License-Identifier: GPL-3.0-or-later
// The data that the program writes into the page of stylet dose (src/io/results/dose/page_data.cpp), and their decoded
// form.
import type { Grid } from '../../../shared/grid_slice';

type Base64 = string;
export type Triple = [number, number, number];

interface RawData {
  prescription_Gy: number | null;
  dvh: { dose_Gy: number[]; percent: number[][] };
  centre_mm: Triple;
  half_mm: number;
  levels: { dose_Gy: number; label: string; color: string; main: boolean }[];
  dose: { size: Triple; origin_mm: Triple; spacing_mm: number; scale_Gy: number; ceiling_Gy: number; values: Base64 };
  difference: { size: Triple; origin_mm: Triple; spacing_mm: number; limit_Gy: number; values: Base64 } | null;
  structures: {
    name: string; region: string; color: string; background: boolean;
    mask: { size: Triple; origin_mm: Triple; spacing_mm: number; share: Base64 } | null;
    surface: { points_mm: Base64; triangles: Base64 } | null;
    contours_mm: Base64[];
    cloud_mm: Base64;
  }[];
  sources: {
    temporary: boolean; length_mm: number; diameter_mm: number;
    places_mm: Base64; axes: Base64; needles: string[]; dwell_s: number[];
  };
}

export interface Level {
  dose: number;   // [Gy]
  label: string;
  color: string;
  main: boolean;  // the prescribed dose
}

export interface Structure {
  name: string;
  region: string;
  color: string;
  background: boolean;         // surrounds the others
  mask: Grid | null;           // 0 … 1: share of each cube that lies within
  surface: { points: Float32Array; triangles: Uint32Array } | null;  // [mm] LPS
  contours: Float32Array[];    // (3 × corners each) [mm] LPS
  cloud: Float32Array;         // (3 × points) [mm] LPS, of a structure without mask
}

export interface Sources {
  count: number;
  temporary: boolean;
  length: number;          // [mm] of the capsule
  diameter: number;        // [mm]
  places: Float32Array;    // (3 × count) [mm] LPS
  axes: Float32Array;      // (3 × count)
  needles: string[];
  dwells: number[];        // [s]
}

/** Computed dose minus that of a file. */
export interface Difference {
  grid: Grid;     // 0: not known; 1 … 255: −limit … limit
  limit: number;  // [Gy]
}

export interface DoseData {
  prescription: number | null;  // [Gy]
  dvh: { dose: number[]; percent: number[][] };
  centre: Triple;  // [mm] LPS
  half: number;    // [mm] half the edge of the cube that the sections show
  levels: Level[];
  dose: Grid;
  ceiling: number;  // [Gy] doses above are given as this one
  difference: Difference | null;
  structures: Structure[];
  sources: Sources;
}

function bytes(text: Base64): ArrayBuffer {
  const binary = atob(text);
  const array = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) array[i] = binary.charCodeAt(i);
  return array.buffer;
}

export function decode(json: string): DoseData {
  const raw = JSON.parse(json) as RawData;
  const floats = (text: Base64) => new Float32Array(bytes(text));
  return {
    prescription: raw.prescription_Gy,
    dvh: { dose: raw.dvh.dose_Gy, percent: raw.dvh.percent },
    centre: raw.centre_mm,
    half: raw.half_mm,
    levels: raw.levels.map(({ dose_Gy: dose, label, color, main }) => ({ dose, label, color, main })),
    dose: {
      size: raw.dose.size, origin: raw.dose.origin_mm, spacing: raw.dose.spacing_mm, scale: raw.dose.scale_Gy,
      values: new Uint16Array(bytes(raw.dose.values)),
    },
    ceiling: raw.dose.ceiling_Gy,
    difference: raw.difference && {
      limit: raw.difference.limit_Gy,
      grid: {
        size: raw.difference.size, origin: raw.difference.origin_mm, spacing: raw.difference.spacing_mm, scale: 1,
        values: new Uint8Array(bytes(raw.difference.values)),
      },
    },
    structures: raw.structures.map((s) => ({
      name: s.name, region: s.region, color: s.color, background: s.background,
      mask: s.mask && {
        size: s.mask.size, origin: s.mask.origin_mm, spacing: s.mask.spacing_mm, scale: 1 / 255,
        values: new Uint8Array(bytes(s.mask.share)),
      },
      surface: s.surface && { points: floats(s.surface.points_mm), triangles: new Uint32Array(bytes(s.surface.triangles)) },
      contours: s.contours_mm.map(floats),
      cloud: floats(s.cloud_mm),
    })),
    sources: {
      count: raw.sources.needles.length, temporary: raw.sources.temporary,
      length: raw.sources.length_mm, diameter: raw.sources.diameter_mm,
      places: floats(raw.sources.places_mm), axes: floats(raw.sources.axes),
      needles: raw.sources.needles, dwells: raw.sources.dwell_s,
    },
  };
}
