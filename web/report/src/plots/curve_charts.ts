// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of a run against time or depth. The depth increases and decreases again: curves are solid on the way in and
// dashed on the way out.
import { nearestStep, turningStep, type EventMark, type ReportData } from '../data';
import type { Moment } from '../moment';
import { INK, lineScale, SOFT } from '../../../shared/plot_style';
import { Chart } from './chart';
import { addLegend, Switches, type Look, type Series } from './series';
import { extent } from './ticks';

const WAY_OUT = [6, 3];

export interface Curve extends Look {
  key: string;
  values: Float32Array;  // one value per step
  text(value: number): string;
}

/** Curves that share a chart. The pointer and the moment refer to the first. */
export interface CurveFamily {
  label: string;                 // label of the y axis, with unit
  curves: Curve[];
  at(event: EventMark): number;  // y value at which an event is marked
}

function buildCurves(box: HTMLElement, data: ReportData, { label, curves, at }: CurveFamily, switches: Switches, moment: Moment, abscissa: 'time_s' | 'depth_mm'): void {
  const { steps } = data;
  if (steps.time_s.length < 2) {
    box.textContent = 'No steps were recorded.';
    return;
  }
  const byTime = abscissa === 'time_s';
  const x = steps[abscissa];
  const turn = turningStep(steps);
  const parts: Series[] = curves.flatMap((curve) => [
    { ...curve, x: x.subarray(0, turn + 1), y: curve.values.subarray(0, turn + 1) },
    { ...curve, x: x.subarray(turn), y: curve.values.subarray(turn), dashes: WAY_OUT },
  ]);
  const [wayIn, wayOut] = parts;
  const stepOf = ({ series, index }: { series: Series; index: number }) => (series === wayIn ? index : turn + index);
  const chart = new Chart(box, {
    x: { label: byTime ? 'Time [s]' : 'Depth [mm]', range: extent([x], byTime ? 0 : 0.02) },
    y: { label, range: extent(curves.map((curve) => curve.values), 0.06) },
    series: parts,
    switches,
    zoom: 'xy',
    events: data.events.map((event) => ({ event, x: byTime ? event.time_s : event.depth_mm, y: at(event) })),
    follow: [wayIn, wayOut],
    pick: byTime ? undefined : 'point',
    tell: (hit) => {
      const step = stepOf(hit);
      return [
        [`${steps.time_s[step].toFixed(3)} s, depth ${steps.depth_mm[step].toFixed(1)} mm`],
        ...curves.map((curve): [string, string, string] => [curve.label, curve.text(curve.values[step]), curve.color]),
      ];
    },
    choose: (hit) => moment.setTime(steps.time_s[stepOf(hit)]),
    // the frame that the 3D view shows
    over: ({ ctx, bbox, valToPos }) => {
      const step = nearestStep(steps, moment.frame.time_s);
      const left = valToPos(x[step], 'x', true);
      if (left < bbox.left || left > bbox.left + bbox.width) return;
      const unit = devicePixelRatio * lineScale();
      ctx.save();
      ctx.strokeStyle = INK;
      ctx.fillStyle = curves[0].color;
      ctx.lineWidth = 1.5 * unit;
      ctx.beginPath();
      if (byTime) {
        ctx.moveTo(left, bbox.top);
        ctx.lineTo(left, bbox.top + bbox.height);
        ctx.stroke();
        ctx.beginPath();
      }
      ctx.arc(left, valToPos(curves[0].values[step], 'y', true), 5 * unit, 0, 2 * Math.PI);
      ctx.fill();
      ctx.stroke();
      ctx.restore();
    },
  });
  moment.onChange(() => chart.redraw());
}

/** Builds the legend of a family of curves and its charts over depth and over time. */
export function buildCurveCharts(legend: HTMLElement, overDepth: HTMLElement, overTime: HTMLElement, data: ReportData, family: CurveFamily, moment: Moment): void {
  const switches = new Switches();
  addLegend(legend, family.curves, switches);
  addLegend(legend, [{ label: 'insertion', color: SOFT }, { label: 'retraction', color: SOFT, dashes: WAY_OUT }]);
  buildCurves(overDepth, data, family, switches, moment, 'depth_mm');
  buildCurves(overTime, data, family, switches, moment, 'time_s');
}
