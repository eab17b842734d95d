// SPDX-License-Identifier: GPL-3.0-or-later
import type { ReportData } from '../data';
import { CURVES, newtons } from '../../../shared/plot_style';
import type { CurveFamily } from './curve_plot';

/** The force of the hand on the needle's base. */
export function forceCurves({ steps }: ReportData): CurveFamily {
  return {
    label: 'Force [N]',
    curves: CURVES.map((c) => ({ ...c, values: steps[c.key] })),
    at: (event) => event.force_N,
    numbers: (i) =>
      `axial ${newtons(steps.axial[i])}<br>sagittal ${newtons(steps.sagittal[i])}<br>lateral ${newtons(steps.lateral[i])}`,
  };
}
