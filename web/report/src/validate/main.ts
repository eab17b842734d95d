// SPDX-License-Identifier: GPL-3.0-or-later
// The plots of the rows of stylet validate. The program writes the data in validation_data.cpp.
import 'uplot/dist/uPlot.min.css';
import '../style.css';
import '../verdict.css';
import './style.css';
import { LEVEL } from '../plots/chart';
import { buildLines } from '../plots/lines';
import { addLegend, type Series } from '../plots/series';
import { element } from '../../../shared/dom';
import { numberText } from '../../../shared/numbers';
import { INK } from '../../../shared/plot_style';
import { build } from '../page_part';

interface Curve {
  label: string;
  kind: 'ours' | 'reference' | 'points';
  x: number[];
  y: number[];
}

interface Plot {
  x_label: string;
  y_label: string;
  log_x: boolean;
  log_y: boolean;
  band: { from: number | null; to: number | null } | null;
  curves: Curve[];
}

// Colours by Okabe & Ito, distinguishable with every kind of colour vision. References are drawn in the text colour.
const OURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#56b4e9', '#e69f00'];

/** A number with few digits; as a power of ten if it is very small or large. */
function text(value: number): string {
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const exponent = Math.floor(Math.log10(size) + 1e-9);
    const digits = Number((value / Math.pow(10, exponent)).toPrecision(2));
    return `${digits === 1 ? '' : `${digits}·`}10${String(exponent).replace(/./g, (c) => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(c)])}`;
  }
  return numberText(Number(value.toPrecision(3)));
}

function seriesOf(plot: Plot): Series[] {
  let ours = 0;
  return plot.curves.map(({ label, kind, x, y }): Series => {
    if (kind === 'points') return { label, x, y, color: INK, shape: 'none', mark: 'disc', small: true };
    if (kind === 'reference') return { label, x, y, color: INK, width: 1.5, dashes: [6, 4] };
    return { label, x, y, color: OURS[ours++ % OURS.length], mark: x.length <= 12 ? 'disc' : undefined };
  });
}

function picture(box: HTMLElement, plot: Plot): void {
  const series = seriesOf(plot);
  buildLines(box, {
    x: { label: plot.x_label, log: plot.log_x, text },
    y: { label: plot.y_label, log: plot.log_y, text },
    level: plot.band ?? undefined,
    series,
  });
  const legend = element('div', 'legend');
  addLegend(legend, [...series, ...(plot.band ? [{ label: 'accepted', color: LEVEL, shape: 'bars' as const }] : [])]);
  box.after(legend);
}

document.documentElement.classList.add('with-script');
const data = JSON.parse(document.getElementById('validation-data')?.textContent ?? '{}') as { plots: Record<string, Plot> };
for (const [id, plot] of Object.entries(data.plots)) build(`plot-${id}`, (box) => picture(box, plot));
