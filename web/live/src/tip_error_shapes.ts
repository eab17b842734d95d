// SPDX-License-Identifier: GPL-3.0-or-later
// The shapes that show the error of the tip, in sections and in 3D: marks in ink on a white rim, which are seen before tissue and
// needle, and between them a white line with edges of ink, which leaves the needle whole where it lies upon it.
import { INK } from '../../shared/plot_style';

export type Place = readonly [number, number];  // [px] of the picture
const WHITE = '#ffffff';
export const LINE_COLORS = [INK, WHITE] as const;  // edges, then the middle
export const LINE_WIDTHS_PX = [3.4, 1.4] as const;
const MARK = { colors: [WHITE, INK], widths: [1.05, 0.4] };  // rim, then ink; widths in radii

function stroke(context: CanvasRenderingContext2D, colors: readonly string[], widths: readonly number[], path: () => void): void {
  context.lineCap = 'round';
  colors.forEach((color, i) => {
    context.strokeStyle = color;
    context.lineWidth = widths[i];
    context.beginPath();
    path();
    context.stroke();
  });
}

function strokeMark(context: CanvasRenderingContext2D, radius: number, path: () => void): void {
  stroke(context, MARK.colors, MARK.widths.map((width) => Math.max(1.2, width * radius)), path);
}

/** Where the tip was to be. @param radius [px] @param weight of its lines, as of a ring with this radius */
export function drawCross(context: CanvasRenderingContext2D, [u, v]: Place, radius: number, weight = radius): void {
  strokeMark(context, weight, () => {
    context.moveTo(u - radius, v);
    context.lineTo(u + radius, v);
    context.moveTo(u, v - radius);
    context.lineTo(u, v + radius);
  });
}

/** Where it is in the tissue. */
export function drawRing(context: CanvasRenderingContext2D, [u, v]: Place, radius: number): void {
  context.fillStyle = '#ffffff';
  context.beginPath();
  context.arc(u, v, radius, 0, 2 * Math.PI);
  context.fill();
  strokeMark(context, radius, () => context.arc(u, v, 0.8 * radius, 0, 2 * Math.PI));
}

/** @param scale 1 on a usual screen */
export function drawLine(context: CanvasRenderingContext2D, from: Place, to: Place, scale: number): void {
  stroke(context, LINE_COLORS, LINE_WIDTHS_PX.map((width) => scale * width), () => {
    context.moveTo(...from);
    context.lineTo(...to);
  });
}
