// SPDX-License-Identifier: GPL-3.0-or-later
// The three sections, as clinics display them (DICOM): transverse seen from the feet, sagittal from the left, coronal
// from the front.

export interface Plane {
  name: string;
  normal: 0 | 1 | 2;  // axis of the patient across the plane
  across: 0 | 1 | 2;  // axis to the right of the picture
  down: 0 | 1 | 2;    // axis along the picture's height
  up: boolean;        // whether `down` grows upwards in the picture
  ends: { left: string; right: string; top: string; bottom: string };
  moves: string;      // the direction of the slider
}

export const PLANES: Plane[] = [
  { name: 'Transverse', normal: 2, across: 0, down: 1, up: false, ends: { left: 'R', right: 'L', top: 'A', bottom: 'P' }, moves: 'z' },
  { name: 'Sagittal', normal: 0, across: 1, down: 2, up: true, ends: { left: 'A', right: 'P', top: 'S', bottom: 'I' }, moves: 'x' },
  { name: 'Coronal', normal: 1, across: 0, down: 2, up: true, ends: { left: 'R', right: 'L', top: 'S', bottom: 'I' }, moves: 'y' },
];

/** Where a point lies in the picture of a plane [mm]: to the right and down. */
export function inPicture({ across, down, up }: Plane, x: ArrayLike<number>, offset = 0): [number, number] {
  return [x[offset + across], up ? -x[offset + down] : x[offset + down]];
}
