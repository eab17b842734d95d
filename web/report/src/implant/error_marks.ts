// SPDX-License-Identifier: GPL-3.0-or-later
// The errors of seeds in a section: an open mark at the planned place, joined to the seed at rest by a line.
import { inPicture } from '../dose/planes';
import { add, NEAR_MM, type MoreMarks } from '../dose/section_picture';
import type { ImplantData } from './data';

const RADIUS = 1.05;  // [mm] of an open mark, so that a seed seen from its end lies inside

/** The open mark for the legend, as SVG. */
export const PLANNED_KEY = '<svg width="14" height="14" viewBox="0 0 3.5 3.5" aria-hidden="true"><circle cx="1.75" cy="1.75" r="1.15" fill="#fff" stroke="#23262b" stroke-width="0.4"/></svg>';
export const ERROR_KEY = '<svg width="30" height="12" viewBox="0 0 7.5 3" aria-hidden="true"><path d="M0.4 1.5H7.1" stroke="#23262b" stroke-width="0.4"/></svg>';

/** Draws the errors of the seeds that are planned, or rest, near the plane. */
export function errorMarks({ seeds }: ImplantData): MoreMarks {
  return (inside, plane, height) => {
    const g = add(inside, 'g', { class: 'errors' });
    const isNear = (x: ArrayLike<number>) => Math.abs(x[plane.normal] - height) <= NEAR_MM;
    for (const { number, needle, planned_mm: planned, rest_mm: rest } of seeds) {
      if (!isNear(planned) && !(rest && isNear(rest))) continue;
      const [x, y] = inPicture(plane, planned);
      const mark = add(g, 'g', {});
      add(mark, 'title', {}, `Seed ${number}, needle ${needle}`);
      if (rest) {
        const [u, v] = inPicture(plane, rest);
        // The line begins at the rim of the open mark.
        const length = Math.hypot(u - x, v - y);
        const share = Math.min(1, RADIUS / Math.max(length, 1e-9));
        const d = `M${(x + share * (u - x)).toFixed(2)} ${(y + share * (v - y)).toFixed(2)}L${u.toFixed(2)} ${v.toFixed(2)}`;
        if (length > RADIUS) add(mark, 'path', { d, class: 'line' });
      }
      for (const kind of ['rim', 'line']) add(mark, 'circle', { cx: x.toFixed(2), cy: y.toFixed(2), r: RADIUS, class: kind });
    }
  };
}
