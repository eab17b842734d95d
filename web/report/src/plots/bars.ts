// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of horizontal bars from a common zero, with their numbers. They are elements of the page, so that their texts
// stay texts.
import { roundDown } from '../../../shared/colors';
import { element } from '../../../shared/dom';
import { numberText } from '../../../shared/numbers';

export interface Bar {
  name: string;
  value: number | null;  // null: there is no bar, only the text
  text: string;
  color: string;
}

/** @param label of the axis, with unit */
export function buildBars(box: HTMLElement, label: string, groups: { name: string; bars: Bar[] }[]): void {
  const values = groups.flatMap(({ bars }) => bars.map(({ value }) => value ?? 0));
  const [least, most] = [Math.min(0, ...values), Math.max(0, ...values)];
  const step = roundDown((most - least) / 3 || 1);
  const [low, high] = [1.1 * least, Math.max(step, step * Math.ceil(most / step))];
  const at = (value: number) => `${(100 * (value - low)) / (high - low)}%`;
  const grid = element('div', 'grid');
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9; k++) {
    const tick = element('span', k === 0 ? 'zero' : '');
    tick.append(element('i', '', numberText(Number((k * step).toPrecision(6)))));
    tick.style.left = at(k * step);
    grid.append(tick);
  }
  const chart = element('div', 'bar-chart');
  box.append(chart);
  chart.append(grid);
  for (const { name, bars } of groups) {
    chart.append(element('b', '', name));
    for (const { name: of, value, text, color } of bars) {
      const track = element('div', 'track');
      const bar = element('i');
      bar.style.cssText = `left:${at(Math.min(0, value ?? 0))};width:calc(${at(low + Math.abs(value ?? 0))} + 1px);background:${color}`;
      const figure = element('span', '', text);
      figure.style.left = at(Math.max(0, value ?? 0));
      if (value !== null) track.append(bar);
      track.append(figure);
      chart.append(element('span', 'name', of), track);
    }
  }
  chart.append(element('div', 'label', label));
}
