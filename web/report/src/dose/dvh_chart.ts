// SPDX-License-Identifier: GPL-3.0-or-later
// Dose–volume histograms with the dose in Gy below and in percent of the prescribed dose above. A second set of
// histograms, that of the plan, is drawn with dashes, and a third one, that of seeds found on images, with dots.
import type uPlot from 'uplot';
import { axis, fontSize, PALE, SOFT } from '../../../shared/plot_style';
import { Chart } from '../plots/chart';
import { addLegend, Switches, type Series } from '../plots/series';
import type { DoseData } from './data';

// Lines differ in dashes too, since the colours are those of the file.
const CURVE_DASHES = [[], [9, 4], [3, 3], [12, 3, 2, 3], [16, 4]];
const PLANNED_DASHES = [7, 5];
const FOUND_DASHES = [2, 3];

function seriesOf({ dvh, structures }: DoseData, planned?: number[][], found?: number[][]): Series[] {
  return structures.flatMap(({ name, color }, k): Series[] => {
    const own = { key: String(k), color, x: dvh.dose_Gy, width: 2.2, label: name, y: dvh.percent[k], dashes: CURVE_DASHES[k % CURVE_DASHES.length] };
    if (!planned) return [own];
    return [
      { ...own, label: `${name}, delivered`, dashes: [] },
      { ...own, label: `${name}, planned`, y: planned[k], dashes: PLANNED_DASHES },
      ...(found ? [{ ...own, label: `${name}, found`, y: found[k], dashes: FOUND_DASHES }] : []),
    ];
  });
}

/** Where the plot ends at first: behind 200 % of the prescribed dose; without one, where the last structure fades out. */
function firstEnd({ dvh, prescription_Gy: prescription }: DoseData): number {
  const last = dvh.dose_Gy[dvh.dose_Gy.length - 1];
  if (prescription) return Math.min(last, 2.5 * prescription);
  return Math.max(...dvh.percent.map((curve) => dvh.dose_Gy[curve.findIndex((v) => v < 1)] ?? last));
}

/** The axis above the plot, in percent of the prescribed dose. */
function percentAxis(prescription: number): uPlot.Axis {
  return {
    ...axis('Dose [% of the prescribed dose]', fontSize() * 2),
    scale: 'x',
    side: 0,
    grid: { show: false },
    splits: (_u, _a, low, high) => {
      const every = (high - low) / prescription > 1.2 ? 0.5 : 0.1;
      const marks: number[] = [];
      for (let k = Math.ceil(low / prescription / every - 1e-9); k * every * prescription <= high + 1e-9; k++) marks.push(k * every * prescription);
      return marks;
    },
    values: (_u, marks) => marks.map((v) => String(Math.round((100 * v) / prescription))),
  };
}

/**
 * @param planned (structures × doses) shares of the plan [%], at the doses of the histograms
 * @param found those of the seeds that were found on images, beside a plan
 */
export function buildDvhChart(data: DoseData, box: HTMLElement, legend: HTMLElement, planned?: number[][], found?: number[][]): void {
  const { structures, prescription_Gy: prescription } = data;
  if (structures.length === 0) {
    box.textContent = 'No structures were given.';
    box.style.height = 'auto';
    return;
  }
  const switches = new Switches();
  const series = seriesOf(data, planned, found);
  new Chart(box, {
    x: {
      label: 'Dose [Gy]', range: [0, firstEnd(data)],
      tell: (dose) => `${dose.toFixed(1)} Gy${prescription ? ` = ${((100 * dose) / prescription).toFixed(0)} %` : ''}`,
    },
    y: { label: 'Volume [%]', range: [0, 102], tell: (percent) => `${percent.toFixed(1)} %` },
    axes: prescription ? () => [percentAxis(prescription)] : undefined,
    rules: [1, 1.5, 2].map((part) => ({ x: part * (prescription ?? NaN), color: PALE, dashes: part === 1 ? [] : [4, 4] })),
    zoom: 'x',
    switches,
    series,
  });
  addLegend(legend, structures.map(({ name }, k) => ({ ...(series.find(({ key }) => key === String(k)) as Series), label: name })), switches);
  if (!planned) return;
  addLegend(legend, [
    { label: 'delivered', color: SOFT }, { label: 'planned', color: SOFT, dashes: PLANNED_DASHES },
    ...(found ? [{ label: 'found on imaging', color: SOFT, dashes: FOUND_DASHES }] : []),
  ]);
}
