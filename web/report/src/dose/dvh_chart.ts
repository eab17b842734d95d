// SPDX-License-Identifier: GPL-3.0-or-later
// Dose–volume histograms with the dose in Gy below and in percent of the prescribed dose above. A second set of
// histograms, that of the plan, is drawn with dashes, and a third one, that of seeds found on images, with dots.
import uPlot from 'uplot';
import { element } from '../../../shared/dom';
import { axis, fontSize, followWidth, lineScale, PALE, SOFT } from '../../../shared/plot_style';
import { showValues } from '../plots/line_plot';
import type { DoseData } from './data';

// Lines differ in dashes too, since the colours are those of the file.
const CURVE_DASHES = [[], [9, 4], [3, 3], [12, 3, 2, 3], [16, 4]];

const PLANNED_DASHES = [7, 5];
const FOUND_DASHES = [2, 3];

/** Vertical lines at 100, 150 and 200 % of the prescribed dose. */
function drawMarks(plot: uPlot, prescription: number): void {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.strokeStyle = PALE;
  ctx.lineWidth = devicePixelRatio;
  for (const percent of [100, 150, 200]) {
    const x = plot.valToPos((percent / 100) * prescription, 'x', true);
    if (x < bbox.left || x > bbox.left + bbox.width) continue;
    ctx.setLineDash(percent === 100 ? [] : [4 * devicePixelRatio, 4 * devicePixelRatio]);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
  }
  ctx.restore();
}

/** A curve of the plot. */
interface Curve {
  structure: number;
  label: string;
  color: string;
  percent: number[];
  dashes: number[];
}

function curvesOf({ dvh, structures }: DoseData, planned?: number[][], found?: number[][]): Curve[] {
  return structures.flatMap(({ name, color }, structure) => {
    const own = { structure, color, label: name, percent: dvh.percent[structure], dashes: CURVE_DASHES[structure % CURVE_DASHES.length] };
    if (!planned) return [own];
    return [
      { ...own, label: `${name}, delivered`, dashes: [] },
      { ...own, label: `${name}, planned`, percent: planned[structure], dashes: PLANNED_DASHES },
      ...(found ? [{ ...own, label: `${name}, found`, percent: found[structure], dashes: FOUND_DASHES }] : []),
    ];
  });
}

const strokeSample = (color: string, dashes: number[]) =>
  `<svg width="40" height="10" aria-hidden="true"><path d="M1 5H39" stroke="${color}" stroke-width="2.5" stroke-dasharray="${dashes.join(' ') || 'none'}" fill="none"/></svg>`;

function buildDvhLegend(box: HTMLElement, data: DoseData, curves: Curve[], plot: uPlot, found: boolean): void {
  data.structures.forEach(({ name, color }, structure) => {
    const own = curves.flatMap((curve, k) => (curve.structure === structure ? [k] : []));
    const toggle = element('button');
    toggle.type = 'button';
    toggle.setAttribute('aria-pressed', 'true');
    toggle.innerHTML = strokeSample(color, curves[own[0]].dashes);
    toggle.append(name);
    toggle.addEventListener('click', () => {
      const show = !plot.series[own[0] + 1].show;
      for (const k of own) plot.setSeries(k + 1, { show });
      toggle.setAttribute('aria-pressed', String(show));
    });
    box.append(toggle);
  });
  if (curves.length === data.structures.length) return;
  const key = element('span', 'key');
  key.innerHTML = `${strokeSample(SOFT, [])}delivered${strokeSample(SOFT, PLANNED_DASHES)}planned${found ? `${strokeSample(SOFT, FOUND_DASHES)}found on imaging` : ''}`;
  box.append(key);
}

/** Where the plot ends at first: behind 200 % of the prescribed dose; without one, where the last structure fades out. */
function firstEnd({ dvh, prescription }: DoseData): number {
  const last = dvh.dose[dvh.dose.length - 1];
  if (prescription) return Math.min(last, 2.5 * prescription);
  return Math.max(...dvh.percent.map((curve) => dvh.dose[curve.findIndex((v) => v < 1)] ?? last));
}

/**
 * @param planned (structures × doses) shares of the plan [%], at the doses of the histograms
 * @param found those of the seeds that were found on images, beside a plan
 */
export function buildDvhChart(data: DoseData, box: HTMLElement, legend: HTMLElement, planned?: number[][], found?: number[][]): void {
  const { dvh, structures, prescription } = data;
  if (structures.length === 0) {
    box.textContent = 'No structures were given.';
    box.style.height = 'auto';
    return;
  }
  const end = firstEnd(data);
  const curves = curvesOf(data, planned, found);
  const percentAxis: uPlot.Axis[] = prescription ? [{
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
  }] : [];
  const plot = new uPlot(
    {
      width: box.clientWidth,
      height: box.clientHeight,
      padding: [prescription ? 0 : fontSize(), fontSize() * 1.5, 0, 0],
      legend: { show: false },
      cursor: { drag: { x: true, y: false }, y: false, points: { size: 7 * lineScale() } },
      scales: {
        x: { time: false, range: (_u, from, to) => (from === null || (from === dvh.dose[0] && to === dvh.dose[dvh.dose.length - 1]) ? [0, end] : [from, to]) },
        y: { range: () => [0, 102] },
      },
      axes: [axis('Dose [Gy]', fontSize() * 2), axis('Volume [%]', fontSize() * 3.2), ...percentAxis],
      series: [{}, ...curves.map(({ label, color, dashes }) => ({
        label, stroke: color, width: 2.2 * lineScale(), dash: dashes.map((d) => d * lineScale()), points: { show: false },
      }))],
      hooks: { drawClear: [(u: uPlot) => (prescription ? drawMarks(u, prescription) : undefined)] },
    } as uPlot.Options,
    [dvh.dose, ...curves.map((curve) => curve.percent)] as uPlot.AlignedData,
    box,
  );
  followWidth(box, plot);
  showValues(plot, {
    lines: curves,
    text: (v) => `${v.toFixed(1)} %`,
    xText: (v) => `${v.toFixed(1)} Gy${prescription ? ` = ${((100 * v) / prescription).toFixed(0)} %` : ''}`,
  });
  buildDvhLegend(legend, data, curves, plot, found !== undefined);
}
