// SPDX-License-Identifier: GPL-3.0-or-later
// The shapes that show the tip error, in sections and in 3D: two dark marks with a white rim, visible against tissue
// and needle, and between them a white line with dark edges, under which the needle remains visible.
import { circle } from '../../shared/canvas';
import { INK } from '../../shared/plot_style';

export type Place = readonly [number, number];  // [px] of the picture
const WHITE = '#ffffff';
export const LINE_COLORS = [INK, WHITE] as const;  // first the edges, then the middle
export const LINE_WIDTHS_PX = [3.4, 1.4] as const;
// first the rim, then the mark; widths relative to the radius
const MARK = { colors: [WHITE, INK], widths: [1.05, 0.4] };

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

/**
 * Draws the planned place of the tip.
 * @param radius [px]
 * @param weight [px] the lines are as wide as the lines of a ring of this radius
 */
export function drawCross(context: CanvasRenderingContext2D, [u, v]: Place, radius: number, weight = radius): void {
  strokeMark(context, weight, () => {
    context.moveTo(u - radius, v);
    context.lineTo(u + radius, v);
    context.moveTo(u, v - radius);
    context.lineTo(u, v + radius);
  });
}

/** Draws the place of the tip in the tissue. */
export function drawRing(context: CanvasRenderingContext2D, [u, v]: Place, radius: number): void {
  context.fillStyle = '#ffffff';
  circle(context, u, v, radius);
  context.fill();
  strokeMark(context, radius, () => context.arc(u, v, 0.8 * radius, 0, 2 * Math.PI));
}

/** Draws the line between the two marks. @param scale width of lines, 1 on a usual screen */
export function drawLine(context: CanvasRenderingContext2D, from: Place, to: Place, scale: number): void {
  stroke(context, LINE_COLORS, LINE_WIDTHS_PX.map((width) => scale * width), () => {
    context.moveTo(...from);
    context.lineTo(...to);
  });
}
