// SPDX-License-Identifier: GPL-3.0-or-later
// Planes through values on a regular grid, and the lines of equal value in them.
import { contours } from 'd3-contour';

export type Axis = 0 | 1 | 2;

/** Values on a regular grid along the patient's axes. */
export interface Grid {
  size: [number, number, number];
  origin: [number, number, number];  // [mm] LPS, the first point
  spacing: number;                   // [mm]
  scale: number;                     // factor on the values
  values: ArrayLike<number>;         // x varies fastest
}

/** The values in a plane; `width` columns along one axis, `height` rows along the other. */
export interface Slice {
  width: number;
  height: number;
  values: Float64Array;
}

/** The values where the coordinate `normal` is `value` [mm], linearly between the grid's points; null outside the grid. */
export function sliceGrid({ size, origin, spacing, values, scale }: Grid, normal: Axis, across: Axis, along: Axis, value: number): Slice | null {
  const at = (value - origin[normal]) / spacing;
  const last = size[normal] - 1;
  if (!(at >= -0.5 && at <= last + 0.5) || values.length === 0) return null;
  const low = Math.max(0, Math.min(Math.max(0, last - 1), Math.floor(at)));
  const share = Math.max(0, Math.min(1, at - low));
  const strides = [1, size[0], size[0] * size[1]];
  const step = last > 0 ? strides[normal] : 0;
  const [width, height] = [size[across], size[along]];
  const out = new Float64Array(width * height);
  for (let j = 0; j < height; j++) {
    for (let i = 0; i < width; i++) {
      const from = i * strides[across] + j * strides[along] + low * strides[normal];
      out[i + j * width] = scale * (values[from] + share * (values[from + step] - values[from]));
    }
  }
  return { width, height, values: out };
}

/** The closed rings around what is at or above a level, in columns and rows. Rings follow the edge of the grid. */
export function ringsOf({ width, height, values }: Slice, level: number): [number, number][][] {
  // d3-contour takes an array of numbers; the type of its declaration is narrower than what it reads.
  const shape = contours().size([width, height]).contour(values as unknown as number[], level);
  return shape.coordinates.flatMap((polygon) => polygon.map((ring) => ring.map(([x, y]): [number, number] => [x - 0.5, y - 0.5])));
}
