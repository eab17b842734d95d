// SPDX-License-Identifier: GPL-3.0-or-later
// Curves on linear or logarithmic scales with labels at their right ends.
import uPlot from 'uplot';
import { marksAt, roundNumbers } from './round_numbers';
import { axis, font, fontSize, followWidth, lineScale, SOFT } from '../../../shared/plot_style';

const BAND = '#f0f1f3';
const LEVEL = '#e3f0f8';

export interface Line {
  label: string;
  color: string;
  values: ArrayLike<number>;
  x?: ArrayLike<number>;  // abscissae of this line, increasing
  dashed?: boolean;
  marks?: boolean;  // draws a dot at every value
  bare?: boolean;   // draws dots only
  width?: number;
}

export interface LinePlot {
  x?: ArrayLike<number>;  // abscissae of all lines that have none of their own
  xLabel: string;
  yLabel: string;
  lines: Line[];
  logX?: number[] | true;  // ticks of a logarithmic x axis; true: decades
  logY?: boolean;
  lowest?: number;     // lower end of a logarithmic y axis
  level?: { from: number | null; to: number | null };  // shaded range of y
  unnamed?: boolean;   // no labels at the curves' ends, because there is a legend
  bands?: { from: number; to: number; label: string }[];  // shaded ranges of x
  text: (value: number) => string;  // formats a y value
  xText: (value: number) => string;
}

function textWidth(texts: string[]): number {
  const context = document.createElement('canvas').getContext('2d');
  if (!context) return 12 * fontSize();
  context.font = font();
  return Math.max(...texts.map((t) => context.measureText(t).width));
}

/** Draws labels at the right ends of the curves, moved apart so that they do not overlap. */
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

/** Shades ranges of x behind the curves. */
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

/** Shades a range of y behind the curves. */
function drawLevel(plot: uPlot, level: NonNullable<LinePlot['level']>): void {
  const { ctx, bbox } = plot;
  const at = (value: number | null, open: number) =>
    value === null ? open : Math.max(bbox.top, Math.min(bbox.top + bbox.height, plot.valToPos(value, 'y', true)));
  const top = at(level.to, bbox.top);
  const bottom = at(level.from, bbox.top + bbox.height);
  ctx.save();
  ctx.fillStyle = LEVEL;
  ctx.fillRect(bbox.left, top, bbox.width, bottom - top);
  ctx.restore();
}

/** The curves over one common list of abscissae; undefined where a curve has no value. */
function aligned(options: LinePlot, drawn: (value: number) => number | null): uPlot.AlignedData {
  const { lines } = options;
  const values = (line: Line) => Array.from(line.values, drawn);
  if (!lines.some((line) => line.x)) return [Array.from(options.x ?? []), ...lines.map(values)] as uPlot.AlignedData;
  return uPlot.join(lines.map((line) => [Array.from(line.x ?? options.x ?? []), values(line)] as uPlot.AlignedData));
}

/** A small box that shows all values of the shown lines at the pointer. */
export function showValues(plot: uPlot, options: {
  lines: { label: string; color: string }[]; text(value: number): string; xText(value: number): string;
}): void {
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
    head.textContent = options.xText(plot.data[0][i]);
    box.append(head);
    for (const [k, line] of options.lines.entries()) {
      const value = plot.data[k + 1][i];
      if (value === null || value === undefined || plot.series[k + 1].show === false) continue;
      const row = document.createElement('div');
      const name = document.createElement('span');
      name.style.color = line.color;
      name.textContent = `${line.label}: `;
      row.append(name, options.text(value));
      box.append(row);
    }
    box.hidden = false;
    const left = plot.cursor.left ?? 0;
    const beside = left + 14 + box.offsetWidth < plot.over.clientWidth ? left + 14 : left - 14 - box.offsetWidth;
    box.style.transform = `translate(${Math.max(0, beside)}px, 8px)`;
  });
}

export function buildLinePlot(box: HTMLElement, options: LinePlot): void {
  const { lines } = options;
  let least = Infinity;
  let most = -Infinity;
  const count = (value: number | null | undefined) => {
    if (value === null || value === undefined || !isFinite(value) || (options.logY && value <= 0)) return;
    most = Math.max(most, value);
    least = Math.min(least, value);
  };
  for (const line of lines) for (let i = 0; i < line.values.length; i++) count(line.values[i]);
  if (!isFinite(most)) throw new Error('there is no value to draw');
  // The whole accepted range is visible, unless it is far away from the curves.
  const reach = options.logY ? [least / 100, most * 100] : [least - 2 * (most - least), most + 2 * (most - least)];
  for (const bound of [options.level?.from, options.level?.to]) {
    if (bound !== null && bound !== undefined && bound >= reach[0] && bound <= reach[1]) count(bound);
  }
  const spare = 0.05 * Math.max(most - Math.min(0, least), 1e-300);
  const low = options.logY ? Math.max(least / 1.5, options.lowest ?? 0) : least < 0 ? least - spare : 0;
  const high = options.logY ? most * 1.5 : most > 0 ? most + spare : 0;
  const data = aligned(options, (v) => (v === null || !isFinite(v) || (options.logY && v <= 0) ? null : v));
  const xs = data[0];
  const first = options.logX ? xs[0] / 1.12 : xs[0];
  const last = options.logX ? xs[xs.length - 1] * 1.12 : xs[xs.length - 1];
  const names = options.unnamed ? fontSize() : textWidth(lines.map((l) => l.label)) + 14;
  const decades = (from: number, to: number) => {
    const marks = roundNumbers(from, to, [1]);
    const every = Math.ceil(marks.length / 6);
    return marks.length > 1 ? marks.filter((_, i) => i % every === 0) : roundNumbers(from, to, [1, 2, 5]);
  };
  const yMarks = options.logY ? marksAt(decades(low, high), options.text) : { values: (_u: uPlot, v: number[]) => v.map(options.text) };
  const xMarks = options.logX ? marksAt(options.logX === true ? decades(first, last) : options.logX, options.logX === true ? options.xText : undefined) : {};
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
        ...(line.bare ? { paths: () => null } : {}),
        points: line.marks ? { show: true, size: (line.bare ? 4 : 7) * unit, fill: line.color, stroke: line.color } : { show: false },
      }))],
      hooks: {
        drawClear: [(u: uPlot) => (options.level ? drawLevel(u, options.level) : undefined), (u: uPlot) => drawBands(u, options.bands ?? [])],
        draw: [(u: uPlot) => (options.unnamed ? undefined : drawNames(u, lines))],
      },
    } as uPlot.Options,
    data,
    box,
  );
  followWidth(box, plot);
  showValues(plot, options);
}
