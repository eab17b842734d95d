// SPDX-License-Identifier: GPL-3.0-or-later
// The three components of the force on the base over the iterations, with marks of events.
import uPlot from 'uplot';
import { drawEvents, labelsHeight, type PlacedEvent } from '../../../shared/event_labels';
import { axis, CURVES, followWidth, fontSize, lineScale, newtons } from '../../../shared/plot_style';
import type { Curves, Run } from './data';

const COLUMNS = { axial: 'axial_N', sagittal: 'sagittal_N', lateral: 'lateral_N' } as const;

/** The events to mark. When a membrane breaks, the region behind it is entered too and gets no mark of its own. */
function placed(run: Run): PlacedEvent[] {
  return run.events
    .filter((e) => e.kind !== 'region_entered' || !run.events.some((o) => o.kind === 'puncture' && o.iteration === e.iteration))
    .map((event) => ({ event, x: event.iteration, y: event.force_N ?? run.curves.axial_N[event.iteration] }));
}

/** Smallest and largest force of all runs, as the common scale of their plots. */
export function forceRange(runs: Run[]): [number, number] {
  let low = 0;
  let high = 0;
  for (const run of runs) {
    for (const column of Object.values(COLUMNS)) {
      for (const force of run.curves[column as keyof Curves]) {
        if (force < low) low = force;
        if (force > high) high = force;
      }
    }
  }
  const room = 0.06 * (high - low);
  return [low - room, high + room];
}

export function buildForcePlot(box: HTMLElement, run: Run, range: [number, number]): void {
  const count = run.curves.axial_N.length;
  const iterations = Array.from({ length: count }, (_, i) => i);
  const events = placed(run);
  const axisSize = fontSize() * 3.2;
  const top = labelsHeight(events, 0, count - 1, box.clientWidth - 2 * axisSize);
  box.style.height = `calc(17rem + ${Math.round(top)}px)`;
  const plot = new uPlot(
    {
      width: box.clientWidth,
      height: box.clientHeight,
      padding: [top, fontSize(), 0, 0],
      legend: { show: false },
      cursor: { drag: { x: true, y: false }, y: false, points: { show: false } },
      scales: { x: { time: false }, y: { range: () => range } },
      axes: [axis('Iteration', fontSize() * 2), axis('Force [N]', axisSize)],
      series: [{}, ...CURVES.map((c) => ({ label: c.label, stroke: c.color, width: c.width * lineScale(), points: { show: false } }))],
      hooks: { draw: [(u: uPlot) => drawEvents(u, events)] },
    } as uPlot.Options,
    [iterations, ...CURVES.map((c) => Array.from(run.curves[COLUMNS[c.key]]))] as uPlot.AlignedData,
    box,
  );
  followWidth(box, plot);

  const readout = document.createElement('div');
  readout.className = 'readout';
  readout.hidden = true;
  plot.over.append(readout);
  plot.over.addEventListener('mouseleave', () => (readout.hidden = true));
  plot.over.addEventListener('mousemove', () => {
    const i = plot.cursor.idx;
    if (i === null || i === undefined) return;
    readout.innerHTML = `<b>iteration ${i}</b><br>` +
      CURVES.map((c) => `${c.label.toLowerCase()} ${newtons(run.curves[COLUMNS[c.key]][i])}`).join('<br>');
    readout.hidden = false;
    const left = plot.cursor.left ?? 0;
    const beside = left + 14 + readout.offsetWidth < plot.over.clientWidth ? left + 14 : left - 14 - readout.offsetWidth;
    readout.style.transform = `translate(${beside}px, 8px)`;
  });
}

export function buildForceLegend(box: HTMLElement): void {
  for (const curve of CURVES) {
    const item = document.createElement('span');
    item.innerHTML = `<svg width="34" height="10" aria-hidden="true"><path d="M1 5H33" stroke="${curve.color}" stroke-width="${curve.width + 0.5}" fill="none"/></svg>`;
    item.append(curve.label);
    box.append(item);
  }
}
