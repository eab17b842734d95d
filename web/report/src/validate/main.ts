// SPDX-License-Identifier: GPL-3.0-or-later
// The plots of the rows of stylet validate. The program writes the data in validation_data.cpp.
import 'uplot/dist/uPlot.min.css';
import '../style.css';
import '../verdict.css';
import './style.css';
import { buildLinePlot, type Line } from '../plots/line_plot';
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

function linesOf(plot: Plot): Line[] {
  let ours = 0;
  return plot.curves.map((curve) => {
    const reference = curve.kind !== 'ours';
    return {
      label: curve.label,
      color: reference ? INK : OURS[ours++ % OURS.length],
      x: curve.x,
      values: curve.y,
      dashed: curve.kind === 'reference',
      bare: curve.kind === 'points',
      marks: curve.kind === 'points' || (curve.kind === 'ours' && curve.x.length <= 12),
      width: reference ? 1.5 : 2,
    };
  });
}

function legend(lines: Line[], plot: Plot): HTMLElement {
  const list = document.createElement('div');
  list.className = 'key';
  for (const line of lines) {
    const item = document.createElement('span');
    const mark = document.createElement('i');
    mark.className = line.bare ? 'dot' : line.dashed ? 'dash' : 'line';
    mark.style.setProperty('--mark', line.color);
    item.append(mark, line.label);
    list.append(item);
  }
  if (plot.band) {
    const item = document.createElement('span');
    const mark = document.createElement('i');
    mark.className = 'area';
    item.append(mark, 'accepted');
    list.append(item);
  }
  return list;
}

function picture(box: HTMLElement, plot: Plot): void {
  const lines = linesOf(plot);
  buildLinePlot(box, {
    xLabel: plot.x_label,
    yLabel: plot.y_label,
    logX: plot.log_x ? true : undefined,
    logY: plot.log_y,
    level: plot.band ?? undefined,
    unnamed: true,
    text,
    xText: text,
    lines,
  });
  box.after(legend(lines, plot));
}

document.documentElement.classList.add('with-script');
const data = JSON.parse(document.getElementById('validation-data')?.textContent ?? '{}') as { plots: Record<string, Plot> };
for (const [id, plot] of Object.entries(data.plots)) build(`plot-${id}`, (box) => picture(box, plot));
