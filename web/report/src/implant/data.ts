// SPDX-License-Identifier: GPL-3.0-or-later
// The data of an implant beside those of its dose (src/io/results/implant/implant_data.cpp).
import type { Triple } from '../dose/data';

export interface Seed {
  number: number;          // from 1, in the order of the plan
  needle: string;
  planned_mm: Triple;      // LPS
  rest_mm: Triple | null;  // LPS; null: the seed is lost
  third: number;           // number in `thirds`
}

/** The seeds found on images, as in summary.json (src/io/results/implant/found_json.cpp). */
export interface Found {
  common_shift_mm: Triple;
  as_found: { parts: ErrorPart[] };
  without_shift: { parts: ErrorPart[] };
  agreement: Record<'x' | 'y' | 'z' | 'all', { correlation: number | null }>;
  seeds: { number: number; needle: string; planned_mm: Triple; rest_mm: Triple; found_mm: Triple; ambiguous: boolean }[];
  not_dropped: { found_mm: Triple }[];
}

export interface ErrorPart {
  cause: string;
  mm2: number;
  percent: number;
}

/** The implant under one of several choices. */
export interface Choice {
  name: string;
  distances_mm: number[];  // of the seeds from their planned places
}

/** The dose while the gland swells, over the days since the implant. */
export interface Oedema {
  days: number[];
  swelling_percent: number[][];  // (3 axes × days)
  D90_Gy: number[];
  D90_without_swelling_Gy: number[];
  in_the_end_Gy: Triple;         // D90, D90 without swelling, their difference
}

/** A needle that is in the tissue together with others. */
export interface NeedleInPlace {
  name: string;
  stabilises: boolean;
  shaft_mm: Triple[];  // LPS, from outside the skin to the tip, with all needles of its group in place
}

/** Words for the parts of an implant: seed and needle, or dwell position and catheter. */
export interface Nouns {
  source: string;
  sources: string;
  needle: string;
  needles: string;
}

/** A noun at the start of a heading. */
export function capital(noun: string): string {
  return noun.charAt(0).toUpperCase() + noun.slice(1);
}

export interface ImplantData {
  nouns: Nouns;
  planned_percent: number[][];  // (structures × doses) histograms of the plan, at the doses of the delivered ones
  found_percent?: number[][];   // those of the seeds that were found on images, where there are any
  found?: Found;
  error: Record<'x_mm' | 'y_mm' | 'z_mm', { mean: number }> & { mean_mm: number; p95_mm: number };
  causes: { name: string; mean_mm: number; mean_xyz_mm: Triple }[];  // those that moved a seed
  choices: Record<string, Choice[]>;  // by the id of their section
  oedema: Oedema | null;
  thirds: { name: string; color: string }[];
  seeds: Seed[];
  needle_diameter_mm: number;
  needles: NeedleInPlace[];
}

export function decodeImplant(json: string): ImplantData {
  return JSON.parse(json) as ImplantData;
}
