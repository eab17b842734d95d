// SPDX-License-Identifier: GPL-3.0-or-later
// How lines of equal dose look, and their legend. They differ in dashes too, not in colour only.
import { element } from '../../../shared/dom';
import type { DoseData } from './data';

const DASHES = ['1.6 0.9', 'none', '3.4 0.9', 'none'];

/** The dashes [mm] of the line of a level, by its number from the coldest. */
export function dashOf(level: number): string {
  return DASHES[level % DASHES.length];
}

function keySample(color: string, dash: string, width: number): string {
  return `<svg width="36" height="12" viewBox="0 0 9 3" aria-hidden="true"><path d="M0.3 1.5H8.7" stroke="${color}" stroke-width="${width}" stroke-dasharray="${dash}" fill="none"/></svg>`;
}

/** The legend of the sections. @param marks further marks as SVG, with their names */
export function buildLevelKey(data: DoseData, box: HTMLElement, marks: [string, string][] = []): void {
  const item = (mark: string, text: string) => {
    const part = element('span');
    part.innerHTML = mark;
    part.append(text);
    box.append(part);
  };
  data.levels.forEach(({ color, label, dose_Gy: dose, main }, k) => {
    const gray = `${Number(dose.toPrecision(4))} Gy`;
    item(keySample(color, dashOf(k), main ? 0.75 : 0.5), label === gray ? label : `${label} (${gray})`);
  });
  for (const { name, color } of data.structures) {
    const part = element('span');
    const mark = element('i', 'area');
    mark.style.setProperty('--mark', color);
    part.append(mark, name);
    box.append(part);
  }
  item('<svg width="30" height="12" viewBox="0 0 7.5 3" aria-hidden="true"><path d="M1.5 1.5H6" stroke="#23262b" stroke-width="1.3" stroke-linecap="round"/></svg>',
    data.sources.temporary ? 'dwell position' : 'seed');
  for (const [mark, name] of marks) item(mark, name);
}
