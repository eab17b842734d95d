// SPDX-License-Identifier: GPL-3.0-or-later
// The charts of the reproduction: times of changes of the mesh, forces on the base, orders of ΔK.
import type { PlacedEvent } from '../../../shared/event_labels';
import { CURVES, SOFT } from '../../../shared/plot_style';
import { Chart } from '../plots/chart';
import { buildNamedLines } from '../plots/lines';
import { addLegend, type Look, type Series } from '../plots/series';
import { extent } from '../plots/ticks';
import { BLUE, colorOf, SKY, VERMILION } from './colors';
import type { Remeshing, ReproductionData, Run } from './data';

export const FORCES: Look[] = [...CURVES];

/** A time in µs, ms or s, with its unit. */
function duration(seconds: number): string {
  const size = Math.abs(seconds);
  const digits = (value: number) => String(Number(value.toPrecision(3)));
  if (size === 0) return '0';
  if (size < 1e-3) return `${digits(seconds * 1e6)} µs`;
  if (size < 1) return `${digits(seconds * 1e3)} ms`;
  return `${digits(seconds)} s`;
}

const iterations = (count: number) => Array.from({ length: count }, (_, i) => i);
const iteration = (i: number) => `iteration ${i}`;

export function buildFigure5(box: HTMLElement, { fig5: rows }: ReproductionData): void {
  const x = rows.map((row) => row.dim);
  buildNamedLines(box, {
    x: { label: 'Order of K', log: true, tell: (dim) => `K ${dim} × ${dim}` },
    y: { label: 'Processor time of one change', log: true, text: duration },
    series: [
      { label: 'inverse from scratch', color: SOFT, x, y: rows.map((row) => row.inverse_s), mark: 'disc' },
      { label: 'boundary condition switches', color: VERMILION, x, y: rows.map((row) => row.bcs_s), mark: 'disc' },
      { label: 'Woodbury', color: BLUE, x, y: rows.map((row) => row.woodbury_s), mark: 'disc' },
      { label: 'Woodbury, one triangle', color: SKY, x, y: rows.map((row) => row.woodbury_symmetric_s), mark: 'disc', dashes: [6, 4] },
    ],
  });
}

/** Sum of the times of the iterations that changed the mesh; no value before the first of them. */
function remeshingOnly(run: Run): (number | null)[] {
  const sums = new Array<number>(run.iterations).fill(0);
  for (const { iteration: at, step_us } of run.remeshings) sums[at] = step_us * 1e-6;
  let sum = 0;
  return sums.map((s) => (sum += s) || null);
}

/** The retraction, from the turning point of the hand until the needle is out. */
function retractions({ events, iterations: count }: Run): { from: number; to: number; label: string }[] {
  const outs = events.filter((event) => event.kind === 'withdrawn');
  return events
    .filter((event) => event.kind === 'retraction_start')
    .map(({ iteration: from }) => ({ from, to: outs.find((out) => out.iteration > from)?.iteration ?? count - 1, label: 'retraction' }));
}

/** @param only whether only the iterations count that change the mesh */
export function buildCumulative(box: HTMLElement, { runs }: ReproductionData, only: boolean): void {
  const x = iterations(runs[0].iterations);
  buildNamedLines(box, {
    x: { label: 'Iteration', tell: iteration },
    y: { label: 'Processor time since the start', log: only, text: duration },
    bands: retractions(runs[runs.length - 1]),
    series: runs.map((run) => ({
      label: run.label, color: colorOf(run.id), width: run.id === 'default' ? 2.5 : 2, x, y: only ? remeshingOnly(run) : run.curves.cumulative_s,
    })),
  });
}

/** The events to mark. When a membrane breaks, the region behind it is entered too and gets no mark of its own. */
function placed({ events, curves }: Run): PlacedEvent[] {
  return events
    .filter((e) => e.kind !== 'region_entered' || !events.some((o) => o.kind === 'puncture' && o.iteration === e.iteration))
    .map((event) => ({ event, x: event.iteration, y: event.force_N ?? curves.axial_N[event.iteration] }));
}

/** The forces of a run, on the common scale of all. */
export function buildForces(box: HTMLElement, run: Run, runs: Run[]): void {
  const x = iterations(run.curves.axial_N.length);
  new Chart(box, {
    x: { label: 'Iteration', range: [0, x.length - 1], tell: iteration },
    y: { label: 'Force [N]', range: extent([[0], ...runs.flatMap(({ curves }) => CURVES.map(({ key }) => curves[`${key}_N`]))], 0.06) },
    zoom: 'x',
    events: placed(run),
    series: CURVES.map((curve) => ({ ...curve, x, y: run.curves[`${curve.key}_N`] })),
  });
}

/** The changes of the mesh of a run, as marks. */
function marksOf({ id, remeshings }: Run): Series[] {
  const series = (look: Pick<Series, 'label' | 'mark' | 'open'>, of: Remeshing[]): Series =>
    ({ ...look, color: colorOf(id), shape: 'none', x: of.map((one) => one.iteration), y: of.map((one) => one.dimension) });
  const moved = remeshings.filter((one) => one.kind === 'repositioned');
  const added = remeshings.filter((one) => one.kind !== 'repositioned');
  if (id === 'default') return [series({ label: 'node added inside an element (default)', mark: 'diamond' }, added)];
  if (id !== 'bcs_repositioning') return [series({ label: 'node added on a face', mark: 'square' }, added)];
  return [
    series({ label: 'node moved', mark: 'disc' }, moved),
    series({ label: 'node added, the nearest could not be moved', mark: 'disc', open: true }, added),
  ];
}

export function buildDimensions(box: HTMLElement, legend: HTMLElement, runs: Run[]): void {
  const series = runs.flatMap(marksOf).filter(({ x }) => x.length > 0);
  if (series.length === 0) {
    box.textContent = 'The mesh was not changed.';
    return;
  }
  addLegend(legend, series);
  new Chart(box, {
    x: { label: 'Iteration', range: [0, runs[0].iterations - 1] },
    y: { label: 'Order of ΔK', range: [0, 1.1 * extent(series.map((one) => one.y as number[]), 0)[1]] },
    pick: 'point',
    tell: ({ series: { x, y, label }, index }) => [[iteration(x[index])], [label, String(y[index])]],
    series,
  });
}
