// SPDX-License-Identifier: GPL-3.0-or-later
// A chart of a report, on linear or logarithmic scales. uPlot draws the axes and zooms; the series are drawn by
// drawSeries(), because their abscissae differ and may go back.
import uPlot from 'uplot';
import { element } from '../../../shared/dom';
import { drawEvents, labelsHeight, textWidth, type PlacedEvent } from '../../../shared/event_labels';
import { numberText } from '../../../shared/numbers';
import { axis, canvasFont, fontSize, lineScale, rem, SOFT } from '../../../shared/plot_style';
import { drawToFit } from '../paper';
import { addLegend, drawSeries, type Series, type Switches } from './series';
import { logTicks } from './ticks';

const BAND = '#f0f1f3';
export const LEVEL = '#e3f0f8';
const MOST_FOR_NAMES = 0.36;  // of the chart's width; wider names make a legend
const NEAR_PX = 24;           // marks further from the pointer are not told

export interface Scale {
  label: string;
  range: [number, number];  // what is shown before one zooms
  log?: boolean;
  text?(value: number): string;  // of a tick
  tell?(value: number): string;  // of a value at the pointer
}

/** A place of a series. */
export interface Hit {
  series: Series;
  index: number;
}

export interface ChartOptions {
  x: Scale;
  y: Scale;
  series: Series[];
  switches?: Switches;
  zoom?: 'x' | 'xy';
  names?: string[];         // the names of the series stand at their right ends, in room for these names
  events?: PlacedEvent[];
  rules?: { x?: number; y?: number; color: string; dashes?: number[]; label?: string }[];  // lines across the chart
  bands?: { from: number; to: number; label: string }[];  // shaded ranges of x
  level?: { from: number | null; to: number | null };     // a shaded range of y
  axes?(): uPlot.Axis[];    // further axes
  over?(plot: uPlot): void; // draws in front of the series
  pick?: 'point';           // the pointer finds the nearest point, else the nearest abscissa
  follow?: Series[];        // the series in which the pointer finds places; otherwise all
  tell?(hit: Hit): [string, string?, string?][];  // what is said about a place instead: names, values and colours
  choose?(hit: Hit): void;  // a click
}

/** The ticks of an axis. */
function ticksOf({ log, text = numberText }: Scale, room: number): Partial<uPlot.Axis> {
  const values = (_plot: uPlot, marks: number[]) => marks.map((mark) => (mark === null ? '' : text(mark)));
  if (!log) return { values };
  const splits = (plot: uPlot, number: number, low: number, high: number) =>
    logTicks(low, high, Math.max(3, (number === 0 ? plot.bbox.width : plot.bbox.height) / devicePixelRatio / room));
  // By itself, uPlot leaves out some of the numbers on a logarithmic axis.
  return { values, splits, filter: (_plot: uPlot, marks: number[]) => marks };
}

export class Chart {
  private plot: uPlot | null = null;
  private readonly window: { x: [number, number]; y: [number, number] };
  private readonly readout = element('div', 'readout');
  private readonly dot = element('div', 'readout-dot');
  private readonly legend = element('div', 'legend names');

  /** @param box its width is followed; with labels of events it becomes higher by them */
  constructor(private readonly box: HTMLElement, private readonly options: ChartOptions) {
    this.window = { x: options.x.range, y: options.y.range };
    box.setAttribute('role', 'img');
    if (!box.hasAttribute('aria-label')) box.setAttribute('aria-label', `${options.y.label} over ${options.x.label}`);
    if (options.names) {
      addLegend(this.legend, options.series);
      box.before(this.legend);
    }
    options.switches?.onChange(() => this.redraw());
    drawToFit(box, () => this.make());
  }

  redraw(): void {
    this.plot?.redraw(false);
  }

  private get shown(): Series[] {
    const { series, switches } = this.options;
    return switches ? series.filter((one) => switches.isShown(one)) : series;
  }

  /** Makes the plot with the size of its box and of the page's text. */
  private make(): void {
    const { box, options, window } = this;
    const { events, zoom, x, y } = options;
    this.plot?.destroy();
    this.plot = null;
    box.style.height = '';
    const width = box.clientWidth;
    if (width === 0) return;
    box.style.setProperty('--drawn-width', `${width / rem()}rem`);  // on paper the chart is not stretched
    const size = fontSize();
    const widest = options.names ? Math.max(...options.names.map(textWidth)) + 14 : 0;
    const namesFit = widest <= MOST_FOR_NAMES * width;
    this.legend.hidden = namesFit;
    const top = events ? labelsHeight(events, ...window.x, width - 6 * size) : options.axes ? 0 : size;
    if (events) box.style.height = `${box.clientHeight + top}px`;
    const scale = (of: Scale, shown: 'x' | 'y'): uPlot.Scale => ({
      time: false, distr: of.log ? 3 : 1, range: (_plot, low, high) => [low ?? window[shown][0], high ?? window[shown][1]],
    });
    const ySize = (_plot: uPlot, values: string[]) => 1.2 * size + Math.max(1.8 * size, ...(values ?? []).map(textWidth));
    const plot = this.plot = new uPlot(
      {
        mode: 2,
        width,
        height: box.clientHeight,
        padding: [top, options.names && namesFit ? widest : 1.2 * size, 0, 0],
        legend: { show: false },
        cursor: {
          show: zoom !== undefined, y: zoom === 'xy', drag: { x: true, y: zoom === 'xy', uni: zoom === 'xy' ? 30 : undefined },
          points: { show: false }, dataIdx: () => null as unknown as number,
        },
        scales: { x: scale(x, 'x'), y: scale(y, 'y') },
        axes: [
          { ...axis(x.label, 2 * size), space: 4 * size, ...ticksOf(x, 4.5 * size) },
          { ...axis(y.label, 0), size: ySize, space: 2 * size, ...ticksOf(y, 2.2 * size) },
          ...(options.axes?.() ?? []),
        ],
        series: [{}, { facets: [{ scale: 'x', auto: false }, { scale: 'y', auto: false }], paths: () => null }],
        hooks: {
          drawClear: [(u: uPlot) => this.drawBehind(u)],
          draw: [(u: uPlot) => this.draw(u, namesFit)],
          setScale: [(u: uPlot, key: string) => {
            const { min, max } = u.scales[key];
            if ((key === 'x' || key === 'y') && min !== undefined && max !== undefined) window[key] = [min, max];
          }],
        },
      } as uPlot.Options,
      [null, [[0, 1], [0, 1]]] as unknown as uPlot.AlignedData,
      box,
    );
    this.show(plot, window.x, window.y);
    this.listen(plot);
  }

  private show(plot: uPlot, x: [number, number], y: [number, number]): void {
    plot.batch(() => {
      plot.setScale('x', { min: x[0], max: x[1] });
      plot.setScale('y', { min: y[0], max: y[1] });
    });
  }

  /** Draws shaded ranges. */
  private drawBehind(plot: uPlot): void {
    const { ctx, bbox } = plot;
    const { bands = [], level } = this.options;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    if (level) {
      const at = (value: number | null, open: number) => (value === null ? open : plot.valToPos(value, 'y', true));
      const top = at(level.to, bbox.top);
      ctx.fillStyle = LEVEL;
      ctx.fillRect(bbox.left, top, bbox.width, at(level.from, bbox.top + bbox.height) - top);
    }
    ctx.font = canvasFont();
    ctx.textAlign = 'center';
    ctx.textBaseline = 'bottom';
    for (const { from, to, label } of bands) {
      const left = plot.valToPos(from, 'x', true);
      const right = plot.valToPos(to, 'x', true);
      ctx.fillStyle = BAND;
      ctx.fillRect(left, bbox.top, right - left, bbox.height);
      ctx.fillStyle = SOFT;
      if (ctx.measureText(label).width < right - left) ctx.fillText(label, (left + right) / 2, bbox.top + bbox.height - 5 * devicePixelRatio);
    }
    ctx.restore();
  }

  private draw(plot: uPlot, withNames: boolean): void {
    const { ctx, bbox } = plot;
    const { events, names, over } = this.options;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top - devicePixelRatio, bbox.width, bbox.height + 2 * devicePixelRatio);
    ctx.clip();
    ctx.lineJoin = 'round';
    this.drawRules(plot);
    for (const series of this.shown) drawSeries(plot, series);
    ctx.restore();
    if (names && withNames) this.drawNames(plot);
    if (events) drawEvents(plot, events);
    over?.(plot);
  }

  private drawRules(plot: uPlot): void {
    const { ctx, bbox } = plot;
    const unit = devicePixelRatio * lineScale();
    for (const { x, y, color, dashes = [], label } of this.options.rules ?? []) {
      ctx.strokeStyle = ctx.fillStyle = color;
      ctx.lineWidth = 1.3 * unit;
      ctx.setLineDash(dashes.map((dash) => dash * unit));
      ctx.beginPath();
      if (x !== undefined) {
        const at = plot.valToPos(x, 'x', true);
        ctx.moveTo(at, bbox.top);
        ctx.lineTo(at, bbox.top + bbox.height);
        ctx.font = canvasFont();
        ctx.textAlign = 'right';
        ctx.fillText(label ?? '', at - 6 * unit, bbox.top + 14 * unit);
      } else if (y !== undefined) {
        const at = plot.valToPos(y, 'y', true);
        ctx.moveTo(bbox.left, at);
        ctx.lineTo(bbox.left + bbox.width, at);
      }
      ctx.stroke();
      ctx.setLineDash([]);
    }
  }

  /** Draws names at the right ends of the curves, moved apart so that they do not overlap. */
  private drawNames(plot: uPlot): void {
    const { ctx, bbox } = plot;
    const step = 1.25 * fontSize() * devicePixelRatio;
    const [ceiling, floor] = [bbox.top + step / 2, bbox.top + bbox.height - step / 2];
    const places = this.options.series
      .map((series) => ({ series, at: plot.valToPos(series.y[series.y.length - 1] ?? 0, 'y', true) }))
      .sort((a, b) => a.at - b.at);
    places.forEach((place, i) => (place.at = Math.max(ceiling, place.at, i > 0 ? places[i - 1].at + step : 0)));
    for (let i = places.length - 1, most = floor; i >= 0; i--, most -= step) places[i].at = Math.min(places[i].at, most);
    ctx.save();
    ctx.font = canvasFont();
    ctx.textAlign = 'left';
    ctx.textBaseline = 'middle';
    for (const { series, at } of places) {
      ctx.fillStyle = series.color;
      ctx.fillText(series.label, bbox.left + bbox.width + 8 * devicePixelRatio, at);
    }
    ctx.restore();
  }

  /** The place nearest to a point of the plot [CSS px]; null where there is none. */
  private nearest(plot: uPlot, left: number, top: number): Hit | null {
    const { follow, pick } = this.options;
    let best: Hit | null = null;
    let least = pick ? NEAR_PX ** 2 : Infinity;
    for (const series of follow ?? this.shown) {
      for (let index = 0; index < series.y.length; index++) {
        const value = series.y[index];
        if (value === null) continue;
        const square = (plot.valToPos(series.x[index], 'x') - left) ** 2 + (pick ? (plot.valToPos(value, 'y') - top) ** 2 : 0);
        if (square < least) [best, least] = [{ series, index }, square];
      }
    }
    return best;
  }

  /** The values of all shown series at the abscissa of a place. */
  private values({ series, index }: Hit): [string, string?, string?][] {
    const { x, y } = this.options;
    const say = ({ tell, text = numberText }: Scale, value: number) => (tell ?? text)(value);
    const at = series.x[index];
    const rows: [string, string?, string?][] = [[say(x, at)]];
    for (const one of this.shown) {
      const value = one.y[Array.prototype.indexOf.call(one.x, at)];
      if (typeof value === 'number') rows.push([one.label, say(y, value), one.color]);
    }
    return rows;
  }

  private tell(plot: uPlot, hit: Hit): void {
    const { readout, dot } = this;
    const { over } = plot;
    const left = plot.valToPos(hit.series.x[hit.index], 'x');
    const top = plot.valToPos(hit.series.y[hit.index] ?? 0, 'y');
    readout.replaceChildren(...(this.options.tell ?? ((at: Hit) => this.values(at)))(hit).map(([name, value, color = 'inherit'], i) => {
      const row = element('div');
      const head = element(i === 0 ? 'b' : 'span', '', value === undefined ? name : `${name}: `);
      head.style.color = color;
      row.append(head, value ?? '');
      return row;
    }));
    readout.hidden = dot.hidden = false;
    dot.style.transform = `translate(${left}px, ${top}px)`;
    dot.style.background = hit.series.color;
    const beside = left + 14 + readout.offsetWidth < over.clientWidth ? left + 14 : left - 14 - readout.offsetWidth;
    const below = Math.max(0, Math.min(over.clientHeight - readout.offsetHeight, top - readout.offsetHeight / 2));
    readout.style.transform = `translate(${Math.max(0, beside)}px, ${below}px)`;
  }

  private listen(plot: uPlot): void {
    const { readout, dot, options } = this;
    const { over } = plot;
    readout.hidden = dot.hidden = true;
    over.append(dot, readout);
    const find = (event: MouseEvent) => {
      const area = over.getBoundingClientRect();
      return this.nearest(plot, event.clientX - area.left, event.clientY - area.top);
    };
    over.addEventListener('mousemove', (event) => {
      const hit = find(event);
      if (hit) this.tell(plot, hit);
      else readout.hidden = dot.hidden = true;
    });
    over.addEventListener('mouseleave', () => (readout.hidden = dot.hidden = true));
    let pressed: [number, number] = [0, 0];
    over.addEventListener('mousedown', (event) => (pressed = [event.clientX, event.clientY]));
    over.addEventListener('click', (event) => {
      const hit = Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4 ? find(event) : null;
      if (hit) options.choose?.(hit);
    });
    over.addEventListener('dblclick', () => this.show(plot, options.x.range, options.y.range));
  }
}
