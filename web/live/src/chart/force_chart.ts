// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on the base as a strip chart over time or depth. uPlot draws scales and axes. The curves are drawn from the
// ring: the steps are divided into stretches and the extremes of each are drawn, so that no peak is lost.
import { circle, strokeLine } from '../../../shared/canvas';
import uPlot from 'uplot';
import { drawEvents, labelsHeight, type PlacedEvent } from '../../../shared/event_labels';
import { axis, CURVES, fontSize, INK, lineScale } from '../../../shared/plot_style';
import { saysHarm, withWords } from '../event_names';
import { HARM } from '../palette';
import { onRepaintEvery } from '../../../shared/repaint';
import type { Session } from '../session';
import { extremes, ForceRing, type ForceName } from './force_ring';

const DRAW_EVERY_MS = 50;
const STRETCHES = 700;  // number of stretches of a curve, at most

export class ForceChart {
  readonly ring = new ForceRing();
  readonly shown = new Set<ForceName>(['axial', 'sagittal', 'lateral']);
  seconds = 20;           // [s] shown time span
  private byDepth = false;
  private plot: uPlot | null = null;
  private textSize = 0;  // [px] text size with which the plot was made
  private events: PlacedEvent[] = [];
  private readonly ends: [number, number] = [0, 0];
  private range = { x: [0, 1] as [number, number], y: [-0.2, 1] as [number, number] };

  constructor(private readonly box: HTMLElement, private readonly session: Session) {
    session.on('frame', (frame) => {
      if (frame.whole) this.ring.clear();
      this.ring.add(frame);
      if (frame.whole || frame.replayed || frame.samples.length > 0) this.draw();
    });
    session.on('restart', () => {
      this.placeEvents();
      this.draw();
    });
    session.on('event', () => {
      this.placeEvents();
      this.draw();
    });
    new ResizeObserver(() => this.resize()).observe(box);
    this.resize();
  }

  get canvas(): HTMLCanvasElement | null {
    return this.plot?.ctx.canvas ?? null;
  }

  setByDepth(on: boolean): void {
    this.byDepth = on;
    this.placeEvents();
    this.plot?.destroy();
    this.plot = null;
    this.resize();
  }

  readonly draw = onRepaintEvery(DRAW_EVERY_MS, () => {
    if (!this.plot) return;
    this.setRange();
    this.plot.batch(() => {
      this.plot?.setScale('x', { min: this.range.x[0], max: this.range.x[1] });
      this.plot?.setScale('y', { min: this.range.y[0], max: this.range.y[1] });
    });
    this.plot.redraw(false, true);
  });

  /** Whether a replay is shown. Its whole curve is known at once, and a mark moves along it. */
  private get replayed(): boolean {
    return this.session.frame?.replayed === true;
  }

  private placeEvents(): void {
    this.events = withWords(this.session.events).map((event) => ({
      event: { label: event.label, color: saysHarm(event) ? HARM : undefined },
      x: this.byDepth ? event.depth_mm : event.time_s,
      y: event.force_N,
    }));
  }

  private setRange(): void {
    const { ring } = this;
    const last = ring.count > 0 ? ring.time[ring.place(ring.count - 1)] : 0;
    const all = this.byDepth || this.replayed;
    const from = all ? 0 : ring.since(last - this.seconds);
    let [low, high] = [-0.2, 1];
    let [near, far] = [0, 10];
    for (let i = from; i < ring.count; i++) {
      const p = ring.place(i);
      for (let c = 0; c < CURVES.length; c++) {
        const value = ring[CURVES[c].key][p];
        if (!this.shown.has(CURVES[c].key)) continue;
        if (value < low) low = value;
        if (value > high) high = value;
      }
      if (ring.depth[p] < near) near = ring.depth[p];
      if (ring.depth[p] > far) far = ring.depth[p];
    }
    const room = 0.06 * (high - low);
    this.range.y = [low - room, high + room];
    const end = Math.max(last, this.seconds);
    this.range.x = this.byDepth ? [near - 1, far + 1] : this.replayed ? [0, Math.max(last, 1)] : [end - this.seconds, end];
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width === 0 || height === 0) return;
    if (this.plot && this.textSize === fontSize()) {
      this.plot.setSize({ width, height });
    } else {  // the text size has changed, by another screen or zoom
      this.plot?.destroy();
      this.textSize = fontSize();
      this.plot = this.makePlot(width, height);
    }
    this.draw();
  }

  private makePlot(width: number, height: number): uPlot {
    const top = () => {
      const [from, to] = this.range.x;
      return Math.min(0.35 * height, labelsHeight(this.events, from, to, Math.max(50, this.box.clientWidth - 5 * fontSize())));
    };
    const size = fontSize();
    return new uPlot({
      mode: 2,
      width,
      height,
      padding: [top, size, 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: { x: { time: false, range: () => this.range.x }, y: { range: () => this.range.y } },
      axes: [axis(this.byDepth ? 'Depth of the base [mm]' : 'Simulated time [s]', size * 1.9), { ...axis('Force [N]', size * 3.6), space: 1.3 * size }],
      series: [{}, { facets: [{ scale: 'x', auto: false }, { scale: 'y', auto: false }], paths: () => null }],
      hooks: { draw: [(u: uPlot) => this.drawCurves(u), (u: uPlot) => drawEvents(u, this.inRange())] },
    } as unknown as uPlot.Options, [null, [[0, 1], [0, 1]]] as unknown as uPlot.AlignedData, this.box);
  }

  private inRange(): PlacedEvent[] {
    const [low, high] = this.range.x;
    return this.events.filter((e) => e.x >= low && e.x <= high);
  }

  private drawCurves(u: uPlot): void {
    const { ring } = this;
    const from = this.byDepth ? 0 : ring.since(this.range.x[0]);
    if (ring.count - from < 2) return;
    const { ctx, bbox } = u;
    const xs: ArrayLike<number> = this.byDepth ? ring.depth : ring.time;
    const unit = devicePixelRatio * lineScale();
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.lineJoin = 'round';
    this.drawZero(u);
    if (this.replayed && !this.byDepth) this.drawMoment(u);
    // The length of stretches is a power of two and they start at its multiples, so that moving curves do not flicker.
    const length = 2 ** Math.ceil(Math.log2(Math.max(1, (ring.count - from) / STRETCHES)));
    const phase = (ring.total - ring.count + from) % length;
    const begin = phase === 0 ? from : from + length - phase;
    for (let c = CURVES.length - 1; c >= 0; c--) {
      const { key, color, width } = CURVES[c];
      if (!this.shown.has(key)) continue;
      ctx.strokeStyle = color;
      ctx.lineWidth = width * unit;
      ctx.beginPath();
      for (let i = begin; i < ring.count; i += length) {
        extremes(ring, ring[key], i, Math.min(i + length, ring.count), this.ends);
        for (let k = 0; k < 2; k++) {
          const p = ring.place(this.ends[k]);
          ctx.lineTo(u.valToPos(xs[p], 'x', true), u.valToPos(ring[key][p], 'y', true));
        }
      }
      const end = ring.place(ring.count - 1);
      ctx.lineTo(u.valToPos(xs[end], 'x', true), u.valToPos(ring[key][end], 'y', true));
      ctx.stroke();
      const p = this.replayed ? ring.place(Math.min(ring.count - 1, ring.since(this.session.frame?.time ?? 0))) : end;
      circle(ctx, u.valToPos(xs[p], 'x', true), u.valToPos(ring[key][p], 'y', true), 3 * unit);
      ctx.fillStyle = color;
      ctx.fill();
    }
    ctx.restore();
  }

  /** Marks the time of a replay. */
  private drawMoment(u: uPlot): void {
    const { ctx, bbox } = u;
    const x = u.valToPos(this.session.frame?.time ?? 0, 'x', true);
    ctx.strokeStyle = INK;
    ctx.lineWidth = 1.5 * devicePixelRatio;
    strokeLine(ctx, x, bbox.top, x, bbox.top + bbox.height);
  }

  private drawZero(u: uPlot): void {
    const { ctx, bbox } = u;
    const y = u.valToPos(0, 'y', true);
    ctx.strokeStyle = '#9aa0a8';
    ctx.lineWidth = devicePixelRatio;
    strokeLine(ctx, bbox.left, y, bbox.left + bbox.width, y);
  }
}
