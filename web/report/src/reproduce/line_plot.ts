// SPDX-License-Identifier: GPL-3.0-or-later
// Curves over one abscissa, named at their right ends, on linear or logarithmic scales.
import uPlot from 'uplot';
import { marksAt, roundNumbers } from '../plots/round_numbers';
import { axis, font, fontSize, followWidth, lineScale } from '../plots/style';
import { SOFT } from './colors';

const BAND = '#f0f1f3';

export interface Line {
  label: string;
  color: string;
  values: ArrayLike<number>;
  dashed?: boolean;
  marks?: boolean;  // a dot at every value
  width?: number;
}

export interface LinePlot {
  x: ArrayLike<number>;
  xLabel: string;
  yLabel: string;
  lines: Line[];
  logX?: number[];     // marks of a logarithmic x axis
  logY?: boolean;
  lowest?: number;     // of a logarithmic y axis
  bands?: { from: number; to: number; label: string }[];  // stretches of x, shaded
  text: (value: number) => string;  // a value of y in words
  xText: (value: number) => string;
}

function textWidth(texts: string[]): number {
  const context = document.createElement('canvas').getContext('2d');
  if (!context) return 12 * fontSize();
  context.font = font();
  return Math.max(...texts.map((t) => context.measureText(t).width));
}

/** Names at the right ends of the curves, pushed apart where they would cover each other. */
function drawNames(plot: uPlot, lines: Line[]): void {
  const ratio = devicePixelRatio;
  const { ctx, bbox } = plot;
  const step = fontSize() * 1.25 * ratio;
  const places = lines
    .map((line) => {
      const last = line.values[line.values.length - 1];
      const end = plot.valToPos(last, 'y', true);
      return { line, end, at: Math.max(bbox.top + step / 2, Math.min(bbox.top + bbox.height - step / 2, end)) };
    })
    .sort((a, b) => a.at - b.at);
  for (let i = 1; i < places.length; i++) places[i].at = Math.max(places[i].at, places[i - 1].at + step);
  const floor = bbox.top + bbox.height - step / 2;
  for (let i = places.length - 1, most = floor; i >= 0; i--, most -= step) places[i].at = Math.min(places[i].at, most);
  ctx.save();
  ctx.font = font().replace(/^[\d.]+/, (size) => String(parseFloat(size) * ratio));
  ctx.textAlign = 'left';
  ctx.textBaseline = 'middle';
  const x = bbox.left + bbox.width;
  for (const { line, at } of places) {
    ctx.fillStyle = line.color;
    ctx.fillText(line.label, x + 8 * ratio, at);
  }
  ctx.restore();
}

/** Shades stretches of x behind the curves. */
function drawBands(plot: uPlot, bands: NonNullable<LinePlot['bands']>): void {
  const ratio = devicePixelRatio;
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.font = font().replace(/^[\d.]+/, (size) => String(parseFloat(size) * ratio));
  ctx.textAlign = 'center';
  ctx.textBaseline = 'bottom';
  for (const { from, to, label } of bands) {
    const left = plot.valToPos(from, 'x', true);
    const right = plot.valToPos(to, 'x', true);
    ctx.fillStyle = BAND;
    ctx.fillRect(left, bbox.top, right - left, bbox.height);
    ctx.fillStyle = SOFT;
    if (ctx.measureText(label).width < right - left) ctx.fillText(label, (left + right) / 2, bbox.top + bbox.height - 5 * ratio);
  }
  ctx.restore();
}

/** A small box with all values at the pointer. */
function readout(plot: uPlot, options: LinePlot): void {
  const box = document.createElement('div');
  box.className = 'readout';
  box.hidden = true;
  plot.over.append(box);
  plot.over.addEventListener('mouseleave', () => (box.hidden = true));
  plot.over.addEventListener('mousemove', () => {
    const i = plot.cursor.idx;
    if (i === null || i === undefined) return;
    box.replaceChildren();
    const head = document.createElement('b');
    head.textContent = options.xText(options.x[i]);
    box.append(head);
    for (const line of options.lines) {
      const row = document.createElement('div');
      const name = document.createElement('span');
      name.style.color = line.color;
      name.textContent = `${line.label}: `;
      row.append(name, options.text(line.values[i]));
      box.append(row);
    }
    box.hidden = false;
    const left = plot.cursor.left ?? 0;
    const beside = left + 14 + box.offsetWidth < plot.over.clientWidth ? left + 14 : left - 14 - box.offsetWidth;
    box.style.transform = `translate(${Math.max(0, beside)}px, 8px)`;
  });
}

export function buildLinePlot(box: HTMLElement, options: LinePlot): void {
  const { lines, x } = options;
  let least = Infinity;
  let most = -Infinity;
  for (const line of lines) {
    for (let i = 0; i < line.values.length; i++) {
      const value = line.values[i];
      if (value > most) most = value;
      if (value < least && value > 0) least = value;
    }
  }
  const low = options.logY ? Math.max(least / 1.5, options.lowest ?? 0) : 0;
  const high = options.logY ? most * 1.5 : most * 1.05;
  const first = options.logX ? x[0] / 1.12 : x[0];
  const last = options.logX ? x[x.length - 1] * 1.12 : x[x.length - 1];
  const names = textWidth(lines.map((l) => l.label)) + 14;
  const yMarks = options.logY ? marksAt(roundNumbers(low, high, [1]), options.text) : { values: (_u: uPlot, v: number[]) => v.map(options.text) };
  const xMarks = options.logX ? marksAt(options.logX) : {};
  const unit = lineScale();
  const plot = new uPlot(
    {
      width: box.clientWidth,
      height: box.clientHeight,
      padding: [fontSize(), names, 0, 0],
      legend: { show: false },
      cursor: { drag: { x: true, y: false }, y: false },
      scales: {
        x: { time: false, distr: options.logX ? 3 : 1, range: (_u, from, to) => (options.logX || from === null ? [first, last] : [from, to]) },
        y: { distr: options.logY ? 3 : 1, range: () => [low, high] },
      },
      axes: [
        { ...axis(options.xLabel, fontSize() * 2), ...xMarks },
        { ...axis(options.yLabel, fontSize() * 4.6), ...yMarks },
      ],
      series: [{}, ...lines.map((line) => ({
        label: line.label,
        stroke: line.color,
        width: (line.width ?? 2) * unit,
        dash: line.dashed ? [6 * unit, 4 * unit] : undefined,
        points: line.marks ? { show: true, size: 7 * unit, fill: line.color, stroke: line.color } : { show: false },
      }))],
      hooks: { drawClear: [(u: uPlot) => drawBands(u, options.bands ?? [])], draw: [(u: uPlot) => drawNames(u, lines)] },
    } as uPlot.Options,
    [Array.from(x), ...lines.map((l) => Array.from(l.values, (v) => (options.logY && v <= 0 ? null : v)))] as uPlot.AlignedData,
    box,
  );
  followWidth(box, plot);
  readout(plot, options);
}

