// SPDX-License-Identifier: GPL-3.0-or-later
// Between a point of the patient (LPS) and the plane of an ultrasound picture.
import type { Place, Ultrasound } from './image';

const dot = (a: ArrayLike<number>, b: ArrayLike<number>) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Coordinates of a point in the plane [mm] to the right and up, and its distance in front of the plane. */
export function inPlane(of: Ultrasound, point: ArrayLike<number>): [number, number, number] {
  const from = [point[0] - of.origin_mm[0], point[1] - of.origin_mm[1], point[2] - of.origin_mm[2]];
  const [r, u] = [of.right, of.up];
  const normal = [r[1] * u[2] - r[2] * u[1], r[2] * u[0] - r[0] * u[2], r[0] * u[1] - r[1] * u[0]];
  return [dot(from, r), dot(from, u), dot(from, normal)];
}

/** The point of the patient at a place of the plane. */
export function inPatient(of: Ultrasound, right: number, up: number): Place {
  return [0, 1, 2].map((k) => of.origin_mm[k] + right * of.right[k] + up * of.up[k]) as Place;
}

const NAMES = [['R', 'L'], ['A', 'P'], ['I', 'S']];

/** The letters at the ends of a direction: where it comes from, and where it leads to. */
export function letters(direction: Place): [string, string] {
  const sizes = direction.map(Math.abs);
  const axis = sizes.indexOf(Math.max(...sizes));
  const [low, high] = NAMES[axis];
  return direction[axis] > 0 ? [low, high] : [high, low];
}
