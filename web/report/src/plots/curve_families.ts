// SPDX-License-Identifier: GPL-3.0-or-later
import { nearestStep, type GlandPath, type ReportData } from '../data';
import { CURVES, newtons } from '../../../shared/plot_style';
import type { CurveFamily } from './curve_charts';

/** The force of the hand on the needle's base. */
export function forceCurves({ steps }: ReportData): CurveFamily {
  return {
    label: 'Force [N]',
    curves: CURVES.map((curve) => ({ ...curve, values: steps[`${curve.key}_N`], text: newtons })),
    at: (event) => event.force_N,
  };
}

/** The mean shift of the gland from its position before the insertion, in the colours of the forces. */
export function glandCurves({ steps }: ReportData, { LR_mm: lr, AP_mm: ap, SI_mm: si }: GlandPath): CurveFamily {
  const curve = (k: number, key: string, values: Float32Array, positive: string, negative: string) => ({
    key, values, color: CURVES[k].color, width: CURVES[k].width, label: `${key} (+ ${positive})`,
    text: (mm: number) => `${Math.abs(mm).toFixed(3)} mm ${mm < 0 ? negative : positive}`,
  });
  return {
    label: 'Shift of the gland [mm]',
    curves: [curve(0, 'SI', si, 'superior', 'inferior'), curve(1, 'AP', ap, 'posterior', 'anterior'), curve(2, 'LR', lr, 'left', 'right')],
    at: (event) => si[nearestStep(steps, event.time_s)],
  };
}
