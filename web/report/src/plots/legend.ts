// SPDX-License-Identifier: GPL-3.0-or-later
// One legend for both plots of a family of curves: chooses the visible curves and explains solid and dashed lines.
import type { Curve } from './curve_plot';

export class CurveChoice {
  private readonly shown: Set<string>;
  private readonly listeners: (() => void)[] = [];

  constructor(readonly curves: Curve[]) {
    this.shown = new Set(curves.map((c) => c.key));
  }

  isShown(key: string): boolean {
    return this.shown.has(key);
  }

  toggle(key: string): void {
    if (!this.shown.delete(key)) this.shown.add(key);
    for (const listener of this.listeners) listener();
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
}

function sample(color: string, width: number, dashed: boolean): string {
  const dash = dashed ? ' stroke-dasharray="5 3"' : '';
  return `<svg width="34" height="10" aria-hidden="true"><path d="M1 5H33" stroke="${color}" stroke-width="${width}"${dash} fill="none"/></svg>`;
}

export function buildLegend(box: HTMLElement, choice: CurveChoice): void {
  for (const curve of choice.curves) {
    const button = document.createElement('button');
    button.type = 'button';
    button.innerHTML = sample(curve.color, curve.width + 0.5, false);
    button.append(curve.label);
    const update = () => button.setAttribute('aria-pressed', String(choice.isShown(curve.key)));
    button.addEventListener('click', () => choice.toggle(curve.key));
    choice.onChange(update);
    update();
    box.append(button);
  }
  const key = document.createElement('span');
  key.className = 'key';
  key.innerHTML = `${sample('#5b6169', 2, false)}insertion ${sample('#5b6169', 2, true)}retraction`;
  box.append(key);
}
