// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of equal value in a plane through a grid.
import { ringsOf, sliceGrid, type Grid, type Slice } from '../../../shared/grid_slice';
import type { Plane } from './planes';

/** The values in a plane, with their places. */
export interface PlacedSlice extends Slice {
  place(column: number, row: number): [number, number];  // [mm] in the picture
}

export type Line = [number, number][];

/** Cuts a grid at a height [mm] along the plane's normal; null outside the grid. */
export function slice(grid: Grid, { normal, across, down, up }: Plane, height: number): PlacedSlice | null {
  const cut = sliceGrid(grid, normal, across, down, height);
  const { origin, spacing } = grid;
  const sign = up ? -1 : 1;
  return cut && { ...cut, place: (column, row) => [origin[across] + spacing * column, sign * (origin[down] + spacing * row)] };
}

const text = (line: Line) => line.map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join('L');

/** The filled shape of what is at or above a level, as the path of an SVG picture. */
export function shapePath(plane: PlacedSlice, level: number): string {
  return ringsOf(plane, level).map((ring) => `M${text(ring.map(([x, y]) => plane.place(x, y)))}Z`).join('');
}

/** The lines at a level, which end at the edge of the grid. */
export function isolines(plane: PlacedSlice, level: number): Line[] {
  const lines: Line[] = [];
  const { width, height } = plane;
  for (const ring of ringsOf(plane, level)) {
    let current: Line = [];
    for (const [x, y] of ring) {
      if (x < 0 || y < 0 || x > width - 1 || y > height - 1) {
        if (current.length > 1) lines.push(current);
        current = [];
      } else {
        current.push(plane.place(x, y));
      }
    }
    if (current.length > 1) lines.push(current);
  }
  return lines;
}

export function linePath(lines: Line[]): string {
  return lines.map((line) => `M${text(line)}`).join('');
}
