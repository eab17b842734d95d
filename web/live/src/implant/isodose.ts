// SPDX-License-Identifier: GPL-3.0-or-later
// Isodose lines in a plane through the dose, in percent of the prescribed dose. The plane and the lines are moved with
// the seeds, because the dose is known in the tissue at rest.
import { ringsOf, sliceGrid, type Axis } from '../../../shared/grid_slice';
import type { Dose } from './implant';

export interface Level { percent: number; color: string; width: number }
export const LEVELS: Level[] = [
  { percent: 50, color: '#4477aa', width: 1.2 },
  { percent: 100, color: '#117733', width: 2.4 },
  { percent: 150, color: '#cc3311', width: 1.2 },
];

export type Ring = [number, number][];  // coordinates along the other two axes, ordered by axis [mm]

/** The lines of one level in a plane, moved by `motion` [mm]. */
export function isodoseRings(dose: Dose, axis: 0 | 2, value: number, percent: number, motion: ArrayLike<number>): Ring[] {
  const [across, along]: [Axis, Axis] = axis === 0 ? [1, 2] : [0, 1];
  const { origin, spacing, unit } = dose;
  const slice = sliceGrid({ ...dose, scale: unit }, axis, across, along, value - motion[axis]);
  if (!slice) return [];
  return ringsOf(slice, percent).map((ring) =>
    ring.map(([i, j]): [number, number] => [origin[across] + motion[across] + spacing * i, origin[along] + motion[along] + spacing * j]));
}

/** The isodose lines of a section, computed anew only if plane, dose or motion have changed. */
export class IsodoseLines {
  private key = '';
  private dose: Dose | null = null;
  private lines: { level: Level; rings: Ring[] }[] = [];

  of(dose: Dose | null, axis: 0 | 2, value: number, motion: [number, number, number]): { level: Level; rings: Ring[] }[] {
    const key = `${value.toFixed(2)} ${motion.map((m) => m.toFixed(1)).join(' ')}`;
    if (dose === this.dose && key === this.key) return this.lines;
    this.dose = dose;
    this.key = key;
    this.lines = dose ? LEVELS.map((level) => ({ level, rings: isodoseRings(dose, axis, value, level.percent, motion) })) : [];
    return this.lines;
  }
}
