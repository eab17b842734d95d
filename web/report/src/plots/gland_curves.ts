// SPDX-License-Identifier: GPL-3.0-or-later
import { nearestStep, type GlandPath, type ReportData } from '../data';
import { CURVES } from '../../../shared/plot_style';
import type { CurveFamily } from './curve_plot';

function direction(mm: number, positive: string, negative: string): string {
  return `${Math.abs(mm).toFixed(3)} mm ${mm < 0 ? negative : positive}`;
}

/** The mean shift of the gland from its position before the insertion. */
export function glandCurves({ steps }: ReportData, { lr, ap, si }: GlandPath): CurveFamily {
  const [first, second, third] = CURVES;  // the colours of the forces
  return {
    label: 'Shift of the gland [mm]',
    curves: [
      { key: 'si', label: 'SI (+ superior)', color: first.color, width: first.width, values: si },
      { key: 'ap', label: 'AP (+ posterior)', color: second.color, width: second.width, values: ap },
      { key: 'lr', label: 'LR (+ left)', color: third.color, width: third.width, values: lr },
    ],
    at: (event) => si[nearestStep(steps, event.time_s)],
    numbers: (i) =>
      [direction(si[i], 'superior', 'inferior'), direction(ap[i], 'posterior', 'anterior'), direction(lr[i], 'left', 'right')].join('<br>'),
  };
}
