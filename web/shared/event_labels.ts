// SPDX-License-Identifier: GPL-3.0-or-later
// Labels of events above a plot, in as many lanes as needed so that they do not overlap, each with a line to its point.
import { circle, strokeLine } from './canvas';
import type uPlot from 'uplot';
import { canvasFont, font, fontSize, INK, lineScale, PALE } from './plot_style';

export interface PlacedEvent {
  event: { label: string; color?: string };
  x: number;  // value on the x scale
  y: number;  // value on the y scale, for the dot
}

interface Label {
  left: number;  // CSS px, relative to the plotting area
  lane: number;
  width: number;
  placed: PlacedEvent;
}

const PADDING = 4;

/** Puts each label in the lowest lane (nearest to the plot) in which it overlaps no other label. */
function arrange(events: PlacedEvent[], position: (x: number) => number, width: number, textWidth: (t: string) => number): Label[] {
  const ends: { from: number; to: number }[][] = [];
  return events
    .map((placed) => ({ placed, at: position(placed.x) }))
    .filter(({ at }) => at >= -1 && at <= width + 1)
    .sort((a, b) => a.at - b.at)
    .map(({ placed, at }) => {
      const labelWidth = textWidth(placed.event.label) + 2 * PADDING;
      const left = Math.max(0, Math.min(width - labelWidth, at - labelWidth / 2));
      const span = { from: left - 3, to: left + labelWidth + 3 };
      let lane = ends.findIndex((taken) => taken.every((t) => span.to <= t.from || span.from >= t.to));
      if (lane < 0) lane = ends.push([]) - 1;
      ends[lane].push(span);
      return { left, lane, width: labelWidth, placed };
    });
}

const widths = new Map<string, number>();
let measuring: CanvasRenderingContext2D | null = null;

/** Width of a text [CSS px]. The results are cached, because few labels are measured often. */
export function textWidth(text: string): number {
  measuring ??= document.createElement('canvas').getContext('2d');
  if (!measuring) return text.length * fontSize() * 0.55;
  const key = `${font()} ${text}`;
  let width = widths.get(key);
  if (width === undefined) {
    if (widths.size > 500) widths.clear();
    measuring.font = font();
    widths.set(key, (width = measuring.measureText(text).width));
  }
  return width;
}

export function laneHeight(): number {
  return fontSize() * 1.5;
}

/** Height [CSS px] of the labels above the plotting area if `width` px show `from` … `to`. */
export function labelsHeight(events: PlacedEvent[], from: number, to: number, width: number): number {
  const labels = arrange(events, (x) => ((x - from) / (to - from)) * width, width, textWidth);
  const lanes = labels.reduce((most, l) => Math.max(most, l.lane + 1), 0);
  return lanes * laneHeight() + 8;
}

/** Draws labels, lines and dots; a hook for uPlot's `draw`. */
export function drawEvents(plot: uPlot, events: PlacedEvent[]): void {
  const ratio = devicePixelRatio;
  const { ctx } = plot;
  const { left, top, width, height } = plot.bbox;
  const labels = arrange(events, (x) => plot.valToPos(x, 'x'), width / ratio, textWidth);
  const lane = laneHeight() * ratio;
  const unit = ratio * lineScale();
  const free = Math.floor((top / ratio - 4) / laneHeight());
  ctx.save();
  ctx.font = canvasFont();
  ctx.textAlign = 'left';
  ctx.textBaseline = 'middle';
  for (const label of labels) {
    const x = plot.valToPos(label.placed.x, 'x', true);
    const y = plot.valToPos(label.placed.y, 'y', true);
    const middle = top - 4 * ratio - (label.lane + 0.5) * lane;
    const dotInside = y >= top && y <= top + height;
    ctx.strokeStyle = label.placed.event.color ?? PALE;
    ctx.lineWidth = unit;
    ctx.setLineDash([3 * unit, 3 * unit]);
    strokeLine(ctx, x, label.lane < free ? middle + lane / 2 - 2 * ratio : top, x, dotInside ? y : top + height);
    ctx.setLineDash([]);
    if (dotInside) {
      circle(ctx, x, y, 3.5 * unit);
      ctx.fillStyle = '#fff';
      ctx.fill();
      ctx.strokeStyle = label.placed.event.color ?? INK;
      ctx.lineWidth = 1.5 * unit;
      ctx.stroke();
    }
  }
  for (const label of labels) {
    if (label.lane >= free) continue;
    const middle = top - 4 * ratio - (label.lane + 0.5) * lane;
    ctx.fillStyle = '#fff';
    ctx.fillRect(left + label.left * ratio, middle - lane / 2 + ratio, label.width * ratio, lane - 2 * ratio);
    ctx.fillStyle = label.placed.event.color ?? INK;
    ctx.fillText(label.placed.event.label, left + (label.left + PADDING) * ratio, middle);
  }
  ctx.restore();
}
