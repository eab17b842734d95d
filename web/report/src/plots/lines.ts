// SPDX-License-Identifier: GPL-3.0-or-later
// Charts of curves whose scales follow from their values.
import { Chart, type ChartOptions } from './chart';
import { extent } from './ticks';

type Axis = Omit<ChartOptions['x'], 'range'>;

/** The range of values from 0, if they are positive; of a logarithmic axis, beyond the values by a factor. */
function rangeOf(values: number[], log: boolean, level: ChartOptions['level']): [number, number] {
  const counted = values.filter((value) => Number.isFinite(value) && (!log || value > 0));
  if (counted.length === 0) throw new Error('there is no value to draw');
  let [low, high] = extent([counted], 0);
  // The whole accepted range is visible, unless it is far away from the curves.
  const reach = log ? [low / 100, high * 100] : [low - 2 * (high - low), high + 2 * (high - low)];
  for (const bound of [level?.from, level?.to]) {
    if (typeof bound === 'number' && bound >= reach[0] && bound <= reach[1]) [low, high] = [Math.min(low, bound), Math.max(high, bound)];
  }
  if (log) return [low / 1.5, high * 1.5];
  const spare = 0.05 * Math.max(high - Math.min(0, low), 1e-300);
  return [low < 0 ? low - spare : 0, high > 0 ? high + spare : 0];
}

type Lines = Omit<ChartOptions, 'x' | 'y'> & { x: Axis; y: Axis };

export function buildLines(box: HTMLElement, { x, y, ...options }: Lines): void {
  const { series, level } = options;
  const xs = series.flatMap((one) => Array.from(one.x));
  const [first, last] = extent([xs], 0);
  new Chart(box, {
    zoom: 'x',
    ...options,
    x: { ...x, range: x.log ? [first / 1.12, last * 1.12] : [first, last] },
    y: { ...y, range: rangeOf(series.flatMap((one) => Array.from(one.y, (value) => value ?? NaN)), y.log ?? false, level) },
  });
}

/** The same with the names of the curves at their right ends. */
export function buildNamedLines(box: HTMLElement, lines: Lines): void {
  buildLines(box, { ...lines, names: lines.series.map(({ label }) => label) });
}
