// SPDX-License-Identifier: GPL-3.0-or-later
import 'uplot/dist/uPlot.min.css';
import '../style.css';
import './style.css';
import { roundNumbers } from '../plots/round_numbers';
import { SOFT } from '../../../shared/plot_style';
import { BLUE, colorOf, SKY, VERMILION } from './colors';
import { decode, type ReproductionData, type Run } from './data';
import { buildDimensionPlot } from './dimension_plot';
import { drawContours, drawSegment, drawSurface } from './drawings';
import { buildForceLegend, buildForcePlot, forceRange } from './force_plot';
import { buildLinePlot } from '../plots/line_plot';
import { build } from '../page_part';

/** A time in µs, ms or s, with its unit. */
function duration(seconds: number): string {
  const size = Math.abs(seconds);
  const digits = (value: number) => String(Number(value.toPrecision(3)));
  if (size === 0) return '0';
  if (size < 1e-3) return `${digits(seconds * 1e6)} µs`;
  if (size < 1) return `${digits(seconds * 1e3)} ms`;
  return `${digits(seconds)} s`;
}

function figure5(box: HTMLElement, data: ReproductionData): void {
  const rows = data.fig5;
  const first = rows[0].dim;
  const last = rows[rows.length - 1].dim;
  buildLinePlot(box, {
    x: rows.map((r) => r.dim),
    xLabel: 'Order of K',
    yLabel: 'Processor time of one change',
    logX: roundNumbers(first / 1.12, last * 1.12, [1, 2, 5]),
    logY: true,
    text: duration,
    xText: (dim) => `K ${dim} × ${dim}`,
    lines: [
      { label: 'inverse from scratch', color: SOFT, values: rows.map((r) => r.inverse_s), marks: true },
      { label: 'boundary condition switches', color: VERMILION, values: rows.map((r) => r.bcs_s), marks: true },
      { label: 'Woodbury', color: BLUE, values: rows.map((r) => r.woodbury_s), marks: true },
      { label: 'Woodbury, one triangle', color: SKY, values: rows.map((r) => r.woodbury_symmetric_s), marks: true, dashed: true },
    ],
  });
}

/** Sum of the times of the iterations that changed the mesh; no value before the first of them. */
function remeshingOnly(run: Run): number[] {
  const sums = new Array<number>(run.iterations).fill(0);
  for (const { iteration, step_us } of run.remeshings) sums[iteration] = step_us * 1e-6;
  let sum = 0;
  return sums.map((s) => (sum += s));
}

/** The retraction, from the turning point of the hand until the needle is out. */
function retractions(run: Run): { from: number; to: number; label: string }[] {
  const outs = run.events.filter((e) => e.kind === 'withdrawn');
  return run.events
    .filter((e) => e.kind === 'retraction_start')
    .map((e) => ({ from: e.iteration, to: outs.find((o) => o.iteration > e.iteration)?.iteration ?? run.iterations - 1, label: 'retraction' }));
}

function cumulative(box: HTMLElement, data: ReproductionData, only: boolean): void {
  buildLinePlot(box, {
    x: Array.from({ length: data.runs[0].iterations }, (_, i) => i),
    xLabel: 'Iteration',
    yLabel: 'Processor time since the start',
    logY: only,
    bands: retractions(data.runs[data.runs.length - 1]),
    text: duration,
    xText: (i) => `iteration ${i}`,
    lines: data.runs.map((run) => ({ label: run.label, color: colorOf(run.id), values: only ? remeshingOnly(run) : run.curves.cumulative_s, width: run.id === 'default' ? 2.5 : 2 })),
  });
}

document.documentElement.classList.add('with-script');
const data = decode(document.getElementById('reproduction-data')?.textContent ?? '');
build('figure5-plot', (b) => figure5(b, data));
build('cumulative-plot', (b) => cumulative(b, data, false));
build('remeshing-plot', (b) => cumulative(b, data, true));
build('force-legend', buildForceLegend);
const range = forceRange(data.runs);
for (const run of data.runs) build(`forces-${run.id}`, (b) => buildForcePlot(b, run, range));
build('dimension-plot', (b) => buildDimensionPlot(b, data.runs));
build('contours', (b) => drawContours(b, data.fig2));
build('surface', (b) => drawSurface(b, data.fig2));
build('segment', (b) => drawSegment(b, data.fig2.needle_segment.symmetric));
build('asymmetric', (b) => drawSegment(b, data.fig2.needle_segment.asymmetric));

