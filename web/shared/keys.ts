// SPDX-License-Identifier: GPL-3.0-or-later
// Legends of colours and marks in a 3D view.
import { roundDown, viridisGradient } from './colors';
import { SLIP_COLOR, STICK_COLOR, TIP_COLOR } from './contact_marks';
import { element } from './dom';

/** Ticks of the colour scale [mm]: round numbers from 0 to at least the largest displacement. */
export function scaleMarks(most: number): number[] {
  const step = roundDown(Math.max(most, 0.01) / 4);
  return Array.from({ length: Math.ceil(most / step - 1e-9) + 1 }, (_, i) => Number((i * step).toPrecision(6)));
}

export function colorBar(marks: number[]): HTMLElement {
  const box = element('div', 'colorbar');
  const strip = element('div', 'strip');
  strip.style.background = viridisGradient('to right');
  const ticks = element('div', 'ticks');
  for (const mark of marks) ticks.append(element('span', '', String(mark)));
  box.append(element('div', 'title', 'moved by [mm]'), strip, ticks);
  return box;
}

export function contactKey(): HTMLElement {
  const key = element('div', 'contact-key');
  for (const [color, shape, text] of [[STICK_COLOR, 'ball', 'sticking'], [SLIP_COLOR, 'ring', 'slipping'], [TIP_COLOR, 'diamond', 'tip']]) {
    const item = element('span');
    const mark = element('i', shape);
    mark.style.setProperty('--mark', color);
    item.append(mark, text);
    key.append(item);
  }
  return key;
}
