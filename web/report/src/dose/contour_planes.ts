// SPDX-License-Identifier: GPL-3.0-or-later
// Contours in the planes in which they were drawn.
import type { Structure } from './data';
import { inPicture, type Plane } from './planes';

const FLAT_MM = 0.05;  // a contour lies in a plane if its corners do within this
const SNAP_MM = 0.25;  // a section this near a plane of contours shows that plane

/** The contours of a structure in one plane. */
export interface ContourPlane {
  height: number;  // [mm] along the plane's normal
  contours: Float32Array[];
}

/** The planes across a normal in which a structure has contours, from below; none if its contours lie otherwise. */
export function contourPlanes({ contours_mm: contours }: Structure, normal: 0 | 1 | 2): ContourPlane[] {
  const planes: ContourPlane[] = [];
  for (const contour of contours) {
    let low = Infinity;
    let high = -Infinity;
    for (let k = normal; k < contour.length; k += 3) {
      low = Math.min(low, contour[k]);
      high = Math.max(high, contour[k]);
    }
    if (!(high - low < FLAT_MM)) return [];
    const height = (low + high) / 2;
    const same = planes.find((plane) => Math.abs(plane.height - height) < FLAT_MM);
    if (same) same.contours.push(contour);
    else planes.push({ height, contours: [contour] });
  }
  return planes.sort((a, b) => a.height - b.height);
}

/** The plane nearest to a height; null without planes. */
export function nearestPlane(planes: ContourPlane[], height: number): ContourPlane | null {
  let best: ContourPlane | null = null;
  for (const plane of planes) if (!best || Math.abs(plane.height - height) < Math.abs(best.height - height)) best = plane;
  return best;
}

/** The height of the nearest plane of contours if that is as good as at the height, else the height itself. */
export function snapped(planes: ContourPlane[], height: number): number {
  const near = nearestPlane(planes, height);
  return near && Math.abs(near.height - height) <= SNAP_MM ? near.height : height;
}

/** Whether a plane of contours is the one at a height. */
export function isAt(plane: ContourPlane | null, height: number): boolean {
  return plane !== null && Math.abs(plane.height - height) < FLAT_MM;
}

/** Contours as the path of an SVG picture, corner by corner. */
export function contourPath(contours: Float32Array[], plane: Plane): string {
  return contours.map((contour) => {
    const corners: string[] = [];
    for (let k = 0; k < contour.length; k += 3) corners.push(inPicture(plane, contour, k).map((mm) => mm.toFixed(2)).join(' '));
    return `M${corners.join('L')}Z`;
  }).join('');
}
