// SPDX-License-Identifier: GPL-3.0-or-later
// Standard views of a 3D view: directions from the anatomy to the observer, LPS.
export const VIEWS: { name: string; from: [number, number, number] }[] = [
  { name: 'Oblique', from: [0.8, -0.56, 0.2] },
  { name: 'From the left', from: [1, 0, 0] },
  { name: 'From the front', from: [0, -1, 0] },
  { name: 'From the feet', from: [0, 0, -1] },
];
