// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of a run against time or depth. The depth increases and decreases again, so the curves are drawn as paths
// through all steps (uPlot's scatter mode), solid on the way in and dashed on the way out.
import uPlot from 'uplot';
import { nearestStep, turningStep, type EventMark, type ReportData } from '../data';
import type { Moment } from '../moment';
import { drawEvents, labelsHeight, type PlacedEvent } from '../../../shared/event_labels';
import type { CurveChoice } from './legend';
import { Readout } from './readout';
import { axis, followWidth, fontSize, INK, lineScale } from '../../../shared/plot_style';

export interface Curve {
  key: string;
  label: string;
  color: string;
  width: number;
  values: Float32Array;  // one value per step
}

/** Curves that share a plot. The pointer and the moment refer to the first. */
export interface CurveFamily {
  label: string;                          // label of the y axis, with unit
  curves: Curve[];
  at(event: EventMark): number;           // y value at which an event is marked
  numbers(step: number): string;          // HTML with the values of the curves at a step
}

export interface CurvePlotOptions {
  box: HTMLElement;
  abscissa: 'time' | 'depth';
  label: string;
}

interface Window {
  x: [number, number];
  y: [number, number];
}

function extent(arrays: Float32Array[], margin: number): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const array of arrays) {
    for (const value of array) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (!(high > low)) return [low - 1 || -1, high + 1 || 1];
  const room = (high - low) * margin;
  return [low - room, high + room];
}

/** Draws the steps from … to of one curve. */
function stroke(plot: uPlot, xs: Float32Array, ys: Float32Array, from: number, to: number): void {
  const { ctx } = plot;
  ctx.beginPath();
  for (let i = from; i <= to; i++) {
    const x = plot.valToPos(xs[i], 'x', true);
    const y = plot.valToPos(ys[i], 'y', true);
    if (i === from) ctx.moveTo(x, y);
    else ctx.lineTo(x, y);
  }
  ctx.stroke();
}

function drawCurve(plot: uPlot, xs: Float32Array, turn: number, { values, color, width }: Curve): void {
  const { ctx, bbox } = plot;
  const unit = devicePixelRatio * lineScale();
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.strokeStyle = color;
  ctx.lineWidth = width * unit;
  ctx.lineJoin = 'round';
  stroke(plot, xs, values, 0, turn);
  ctx.setLineDash([6 * unit, 3 * unit]);
  stroke(plot, xs, values, turn, xs.length - 1);
  ctx.restore();
}

/** Marks the frame that the 3D view shows: a vertical line (over time) and a dot on the first curve. */
function drawMoment(plot: uPlot, x: number, y: number, color: string, asLine: boolean): void {
  const { ctx, bbox } = plot;
  const unit = devicePixelRatio * lineScale();
  const at = plot.valToPos(x, 'x', true);
  if (at < bbox.left || at > bbox.left + bbox.width) return;
  ctx.save();
  ctx.strokeStyle = INK;
  ctx.lineWidth = 1.5 * unit;
  if (asLine) {
    ctx.beginPath();
    ctx.moveTo(at, bbox.top);
    ctx.lineTo(at, bbox.top + bbox.height);
    ctx.stroke();
  }
  ctx.beginPath();
  ctx.arc(at, plot.valToPos(y, 'y', true), 5 * unit, 0, 2 * Math.PI);
  ctx.fillStyle = color;
  ctx.fill();
  ctx.stroke();
  ctx.restore();
}

export function buildCurvePlot(data: ReportData, family: CurveFamily, choice: CurveChoice, moment: Moment,
                               options: CurvePlotOptions): void {
  const { steps } = data;
  const { curves } = family;
  const first = curves[0].values;
  const { box, abscissa } = options;
  if (steps.time.length < 2) {
    box.textContent = 'No steps were recorded.';
    return;
  }
  const xs = steps[abscissa];
  const turn = turningStep(steps);
  const events: PlacedEvent[] = data.events.map((event) => ({
    event,
    x: abscissa === 'time' ? event.time_s : event.depth_mm,
    y: family.at(event),
  }));
  const whole: Window = {
    x: extent([xs], abscissa === 'time' ? 0 : 0.02),
    y: extent(curves.map((c) => c.values), 0.06),
  };
  const axisSize = fontSize() * 4;
  const top = labelsHeight(events, whole.x[0], whole.x[1], box.clientWidth - 2 * axisSize);

  const plot = new uPlot(
    {
      mode: 2,
      width: box.clientWidth,
      height: box.clientHeight,
      padding: [top, fontSize(), 0, 0],
      legend: { show: false },
      cursor: { drag: { x: true, y: true, uni: 30 }, points: { show: false }, dataIdx: () => null as unknown as number },
      scales: {
        x: { time: false, range: (_u, low, high) => [low ?? whole.x[0], high ?? whole.x[1]] },
        y: { range: (_u, low, high) => [low ?? whole.y[0], high ?? whole.y[1]] },
      },
      axes: [axis(options.label, fontSize() * 2), axis(family.label, axisSize)],
      series: [{}, ...curves.map((c) => ({
        label: c.label,
        facets: [{ scale: 'x', auto: true }, { scale: 'y', auto: true }],
        paths: (u: uPlot) => {
          if (choice.isShown(c.key)) drawCurve(u, xs, turn, c);
          return null;
        },
      }))],
      hooks: {
        draw: [
          (u: uPlot) => {
            drawEvents(u, events);
            const i = nearestStep(steps, moment.frame.time);
            drawMoment(u, xs[i], first[i], curves[0].color, abscissa === 'time');
          },
        ],
      },
    } as uPlot.Options,
    [null, ...curves.map((c) => [xs, c.values])] as unknown as uPlot.AlignedData,
    box,
  );
  const show = (window: Window) => {
    plot.batch(() => {
      plot.setScale('x', { min: window.x[0], max: window.x[1] });
      plot.setScale('y', { min: window.y[0], max: window.y[1] });
    });
  };
  show(whole);
  followWidth(box, plot);
  choice.onChange(() => plot.redraw(false));
  moment.onChange(() => plot.redraw(false));

  const readout = new Readout(plot, (i) =>
    `<b>${steps.time[i].toFixed(3)} s</b>, depth ${steps.depth[i].toFixed(1)} mm<br>${family.numbers(i)}`);
  const stepAt = (left: number, y: number): number => {
    if (abscissa === 'time') return nearestStep(steps, plot.posToVal(left, 'x'));
    let best = 0;
    let distance = Infinity;
    for (let i = 0; i < xs.length; i++) {
      const dx = plot.valToPos(xs[i], 'x') - left;
      const dy = plot.valToPos(first[i], 'y') - y;
      const d = dx * dx + dy * dy;
      if (d < distance) [best, distance] = [i, d];
    }
    return best;
  };
  const place = (e: MouseEvent) => {
    const area = plot.over.getBoundingClientRect();
    return stepAt(e.clientX - area.left, e.clientY - area.top);
  };
  plot.over.addEventListener('mousemove', (e) => {
    const i = place(e);
    readout.show(i, xs[i], first[i]);
  });
  plot.over.addEventListener('mouseleave', () => readout.hide());
  let pressed: [number, number] = [0, 0];
  plot.over.addEventListener('mousedown', (e) => (pressed = [e.clientX, e.clientY]));
  plot.over.addEventListener('click', (e) => {
    if (Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) < 4) moment.setTime(steps.time[place(e)]);
  });
  plot.over.addEventListener('dblclick', () => show(whole));
}
