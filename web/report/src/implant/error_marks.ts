// SPDX-License-Identifier: GPL-3.0-or-later
// The errors of seeds in a section: an open mark at the planned place, joined to the seed at rest by a line. Seeds that
// were found on images are crosses.
import { inPicture } from '../dose/planes';
import { add } from '../../../shared/svg';
import { NEAR_MM, type MoreMarks } from '../dose/section_picture';
import { capital, type ImplantData } from './data';

const RADIUS = 1.05;  // [mm] of an open mark, so that a seed seen from its end lies inside

/** The open mark for the legend, as SVG. */
export const PLANNED_KEY = '<svg width="14" height="14" viewBox="0 0 3.5 3.5" aria-hidden="true"><circle cx="1.75" cy="1.75" r="1.15" fill="#fff" stroke="#23262b" stroke-width="0.4"/></svg>';
export const ERROR_KEY = '<svg width="30" height="12" viewBox="0 0 7.5 3" aria-hidden="true"><path d="M0.4 1.5H7.1" stroke="#23262b" stroke-width="0.4"/></svg>';

export const FOUND_KEY = '<svg width="14" height="14" viewBox="0 0 3.5 3.5" aria-hidden="true"><path d="M0.6 0.6L2.9 2.9M2.9 0.6L0.6 2.9" stroke="#c44601" stroke-width="0.5"/></svg>';

const ARM = 0.95;  // [mm] half the width of a cross

/** Draws the errors of the seeds that are planned, or rest, near the plane, and the found ones near it. */
export function errorMarks({ nouns, seeds, found }: ImplantData): MoreMarks {
  return (inside, plane, height) => {
    const g = add(inside, 'g', { class: 'errors' });
    const isNear = (x: ArrayLike<number>) => Math.abs(x[plane.normal] - height) <= NEAR_MM;
    for (const { number, needle, planned_mm: planned, rest_mm: rest } of seeds) {
      if (!isNear(planned) && !(rest && isNear(rest))) continue;
      const [x, y] = inPicture(plane, planned);
      const mark = add(g, 'g', {});
      add(mark, 'title', {}, `${capital(nouns.source)} ${number}, ${nouns.needle} ${needle}`);
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
    const places = found ? [...found.seeds, ...found.not_dropped.map((one) => ({ ...one, number: null }))] : [];
    for (const { number, found_mm: place } of places) {
      if (!isNear(place)) continue;
      const [x, y] = inPicture(plane, place);
      const mark = add(g, 'g', { class: 'found' });
      add(mark, 'title', {}, number === null ? 'Found; matches no simulated seed' : `Seed ${number} as found`);
      const d = `M${(x - ARM).toFixed(2)} ${(y - ARM).toFixed(2)}l${2 * ARM} ${2 * ARM}m0 ${-2 * ARM}l${-2 * ARM} ${2 * ARM}`;
      for (const kind of ['rim', 'line']) add(mark, 'path', { d, class: kind });
    }
  };
}
