// SPDX-License-Identifier: GPL-3.0-or-later
// Isodose lines in a plane through the dose, in percent of the prescribed dose. The plane and the lines are moved with
// the seeds, because the dose is known in the tissue at rest.
import { contours } from 'd3-contour';
import type { Dose } from './implant';

export interface Level { percent: number; color: string; width: number }
export const LEVELS: Level[] = [
  { percent: 50, color: '#4477aa', width: 1.2 },
  { percent: 100, color: '#117733', width: 2.4 },
  { percent: 150, color: '#cc3311', width: 1.2 },
];

export type Ring = [number, number][];  // coordinates along the other two axes, ordered by axis [mm]

/** The dose in the plane where the coordinate `axis` is `value`, linearly between the grid's points; null outside. */
export function sliceOf(dose: Dose, axis: 0 | 2, value: number): { width: number; height: number; values: number[] } | null {
  const { size, origin, spacing, values, unit } = dose;
  const at = (value - origin[axis]) / spacing;
  if (!(at >= 0 && at <= size[axis] - 1)) return null;
  const low = Math.min(Math.floor(at), size[axis] - 2);
  const share = at - low;
  const strides = [1, size[0], size[0] * size[1]];
  const [across, along] = axis === 0 ? [1, 2] : [0, 1];
  const out: number[] = [];
  for (let j = 0; j < size[along]; j++) {
    for (let i = 0; i < size[across]; i++) {
      const from = i * strides[across] + j * strides[along] + low * strides[axis];
      out.push(unit * ((1 - share) * values[from] + share * values[from + strides[axis]]));
    }
  }
  return { width: size[across], height: size[along], values: out };
}

/** The lines of one level in a plane, moved by `motion` [mm]. */
export function isodoseRings(dose: Dose, axis: 0 | 2, value: number, percent: number, motion: ArrayLike<number>): Ring[] {
  const slice = sliceOf(dose, axis, value - motion[axis]);
  if (!slice) return [];
  const [across, along] = axis === 0 ? [1, 2] : [0, 1];
  const { origin, spacing } = dose;
  return contours().size([slice.width, slice.height]).contour(slice.values, percent).coordinates.flatMap((polygon) => polygon.map((ring) =>
    ring.map(([i, j]) => [origin[across] + motion[across] + spacing * (i - 0.5), origin[along] + motion[along] + spacing * (j - 0.5)] as [number, number])));
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
