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

export interface FoundSeed {
  found_mm: Triple;       // LPS
  number: number | null;  // that of its seed; null: it matches none
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
  found?: FoundSeed[];
  thirds: { name: string; color: string }[];
  seeds: Seed[];
  needle_diameter_mm: number;
  needles: NeedleInPlace[];
}

export function decodeImplant(json: string): ImplantData {
  return JSON.parse(json) as ImplantData;
}
