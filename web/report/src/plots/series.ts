// SPDX-License-Identifier: GPL-3.0-or-later
// The series of charts, how they are drawn, and their legends.
import type uPlot from 'uplot';
import { element } from '../../../shared/dom';
import { lineScale } from '../../../shared/plot_style';

/** Shapes of marks as SVG paths around (0, 0). */
const MARKS = {
  disc: 'M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0-9 0z',
  square: 'M-4-4h8v8h-8z',
  triangle: 'M0-5.5l5 9h-10z',
  diamond: 'M0-5.4L5.4 0L0 5.4L-5.4 0z',
};

export interface Look {
  label: string;
  key?: string;       // the switch that hides it
  color: string;
  shape?: 'line' | 'steps' | 'bars' | 'none';
  width?: number;     // [CSS px] of the line
  dashes?: number[];  // [CSS px]
  mark?: keyof typeof MARKS;
  small?: boolean;    // marks of half the size
  open?: boolean | ((index: number) => boolean);  // whether marks are not filled
}

export interface Series extends Look {
  x: ArrayLike<number>;         // of bars: their edges, one more than their heights
  y: ArrayLike<number | null>;  // null: no value
}

/** Which series of charts are shown. */
export class Switches {
  private readonly hidden = new Set<string>();
  private readonly listeners: (() => void)[] = [];

  isShown({ key }: { key?: string }): boolean {
    return key === undefined || !this.hidden.has(key);
  }

  toggle(key: string): void {
    if (!this.hidden.delete(key)) this.hidden.add(key);
    for (const listener of this.listeners) listener();
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
}

export function drawSeries(plot: uPlot, series: Series): void {
  const { ctx, bbox } = plot;
  const { x, y, shape = 'line', color, width = 2, dashes = [], mark, open } = series;
  const unit = devicePixelRatio * lineScale();
  const right = (i: number) => plot.valToPos(x[i], 'x', true);
  const down = (i: number) => (y[i] === null ? NaN : plot.valToPos(y[i] as number, 'y', true));
  ctx.strokeStyle = ctx.fillStyle = color;
  ctx.lineWidth = width * unit;
  if (shape === 'bars') {
    for (let i = 0; i < y.length; i++) {
      const from = right(i);
      if (y[i]) ctx.fillRect(from + 0.5, down(i), Math.max(1, right(i + 1) - from - 1), bbox.top + bbox.height - down(i));
    }
  } else if (shape !== 'none') {
    ctx.setLineDash(dashes.map((dash) => dash * unit));
    ctx.beginPath();
    let before = NaN;  // where there is no value the line has a gap
    for (let i = 0; i < y.length; i++) {
      const at = down(i);
      if (Number.isFinite(before) && Number.isFinite(at)) {
        if (shape === 'steps') ctx.lineTo(right(i), before);
        ctx.lineTo(right(i), at);
      } else if (Number.isFinite(at)) ctx.moveTo(right(i), at);
      before = at;
    }
    ctx.stroke();
    ctx.setLineDash([]);
  }
  if (!mark) return;
  const path = new Path2D(MARKS[mark]);
  const scale = (series.small ? 0.5 : shape === 'none' ? 1 : 0.8) * unit;
  ctx.lineWidth = 1.7;
  for (let i = 0; i < y.length; i++) {
    if (!Number.isFinite(down(i))) continue;
    ctx.save();
    ctx.translate(right(i), down(i));
    ctx.scale(scale, scale);
    if (typeof open === 'function' ? open(i) : open) ctx.stroke(path);
    else {
      ctx.globalAlpha = shape === 'none' && !series.small ? 0.72 : 1;
      ctx.fill(path);
    }
    ctx.restore();
  }
}

/** A sample of a series, as SVG. */
function sample({ color, shape = 'line', width = 2, dashes = [], mark, small, open }: Look): string {
  const line = shape === 'none' ? '' : shape === 'bars' ? `<path d="M-16-5h32v10h-32z" fill="${color}"/>`
    : `<path d="M-16 0h32" stroke="${color}" stroke-width="${width + 0.5}" stroke-dasharray="${dashes.join(' ') || 'none'}" fill="none"/>`;
  const paint = open === true ? `fill="none" stroke-width="1.7" stroke="${color}"` : `fill="${color}"`;
  const dot = mark ? `<path d="${MARKS[mark]}" ${paint}${small ? ' transform="scale(0.5)"' : ''}/>` : '';
  const half = shape === 'none' ? 7 : 17;
  return `<svg width="${2 * half}" height="14" viewBox="${-half} -7 ${2 * half} 14" aria-hidden="true">${line}${dot}</svg>`;
}

/** Puts samples of series with their names into a box; series with a key become buttons that hide and show them. */
export function addLegend(box: HTMLElement, series: Look[], switches?: Switches): void {
  for (const look of series) {
    const { key } = look;
    const item = element(switches && key !== undefined ? 'button' : 'span');
    item.innerHTML = sample(look);
    item.append(look.label);
    if (item instanceof HTMLButtonElement && switches && key !== undefined) {
      item.type = 'button';
      item.addEventListener('click', () => switches.toggle(key));
      const update = () => item.setAttribute('aria-pressed', String(switches.isShown(look)));
      switches.onChange(update);
      update();
    }
    box.append(item);
  }
}
