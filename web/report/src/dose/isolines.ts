// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of equal value in a plane through a grid.
import { contours } from 'd3-contour';
import type { Grid } from './data';
import type { Plane } from './planes';

/** The values in a plane, linearly between the grid's points. */
export interface Slice {
  width: number;
  height: number;
  values: Float64Array;
  place(column: number, row: number): [number, number];  // [mm] in the picture
}

export type Line = [number, number][];

/** Cuts a grid at a height [mm] along the plane's normal; null outside the grid. */
export function slice(grid: Grid, plane: Plane, height: number): Slice | null {
  const { size, origin, spacing, values, scale } = grid;
  const at = (height - origin[plane.normal]) / spacing;
  const last = size[plane.normal] - 1;
  if (!(at >= -0.5 && at <= last + 0.5) || values.length === 0) return null;
  const low = Math.max(0, Math.min(Math.max(0, last - 1), Math.floor(at)));
  const high = Math.min(last, low + 1);
  const share = Math.max(0, Math.min(1, at - low));
  const strides = [1, size[0], size[0] * size[1]];
  const width = size[plane.across];
  const rows = size[plane.down];
  const out = new Float64Array(width * rows);
  for (let j = 0; j < rows; j++) {
    for (let i = 0; i < width; i++) {
      const start = i * strides[plane.across] + j * strides[plane.down];
      const a = values[start + low * strides[plane.normal]];
      const b = values[start + high * strides[plane.normal]];
      out[i + j * width] = scale * (a + share * (b - a));
    }
  }
  const sign = plane.up ? -1 : 1;
  return {
    width, height: rows, values: out,
    place: (column, row) => [origin[plane.across] + spacing * column, sign * (origin[plane.down] + spacing * row)],
  };
}

/** The closed rings around what is at or above a level [mm in the picture]. Rings follow the edge of the grid. */
function rings({ width, height, values, place }: Slice, level: number): { line: Line; border: boolean[] }[] {
  // d3-contour takes an array of numbers; the type of its declaration is narrower than what it reads.
  const shape = contours().size([width, height]).contour(values as unknown as number[], level);
  return shape.coordinates.flatMap((polygon) => polygon.map((ring) => ({
    line: ring.map(([x, y]) => place(x - 0.5, y - 0.5)),
    border: ring.map(([x, y]) => x < 0.5 || y < 0.5 || x > width - 0.5 || y > height - 0.5),
  })));
}

const text = (line: Line) => line.map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join('L');

/** The filled shape of what is at or above a level, as the path of an SVG picture. */
export function shapePath(plane: Slice, level: number): string {
  return rings(plane, level).map(({ line }) => `M${text(line)}Z`).join('');
}

/** The lines at a level, which end at the edge of the grid. */
export function isolines(plane: Slice, level: number): Line[] {
  const lines: Line[] = [];
  for (const { line, border } of rings(plane, level)) {
    let current: Line = [];
    for (let i = 0; i < line.length; i++) {
      if (border[i]) {
        if (current.length > 1) lines.push(current);
        current = [];
      } else {
        current.push(line[i]);
      }
    }
    if (current.length > 1) lines.push(current);
  }
  return lines;
}

export function linePath(lines: Line[]): string {
  return lines.map((line) => `M${text(line)}`).join('');
}
