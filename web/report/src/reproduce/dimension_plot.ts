// SPDX-License-Identifier: GPL-3.0-or-later
// The order of ΔK of each change of the mesh, as one mark per change.
import uPlot from 'uplot';
import { axis, followWidth, fontSize, lineScale } from '../../../shared/plot_style';
import type { Remeshing, Run } from './data';
import { colorOf } from './colors';

interface Marks {
  label: string;
  color: string;
  hollow: boolean;
  shape: 'disc' | 'square' | 'diamond';
  points: Remeshing[];
}

function marksOf(runs: Run[]): Marks[] {
  const list: Marks[] = [];
  for (const run of runs) {
    const moved = run.remeshings.filter((r) => r.kind === 'repositioned');
    const added = run.remeshings.filter((r) => r.kind !== 'repositioned');
    const color = colorOf(run.id);
    if (run.id === 'bcs_repositioning') {
      list.push({ label: 'node moved', color, hollow: false, shape: 'disc', points: moved });
      list.push({ label: 'node added, the nearest could not be moved', color, hollow: true, shape: 'disc', points: added });
    } else {
      list.push({
        label: run.id === 'default' ? 'node added inside an element (default)' : 'node added on a face',
        color, hollow: false, shape: run.id === 'default' ? 'diamond' : 'square', points: added,
      });
    }
  }
  return list.filter((m) => m.points.length > 0);
}

function trace(ctx: CanvasRenderingContext2D, shape: Marks['shape'], x: number, y: number, r: number): void {
  ctx.beginPath();
  if (shape === 'disc') ctx.arc(x, y, r, 0, 2 * Math.PI);
  else if (shape === 'square') ctx.rect(x - 0.85 * r, y - 0.85 * r, 1.7 * r, 1.7 * r);
  else {
    ctx.moveTo(x, y - 1.2 * r);
    ctx.lineTo(x + 1.2 * r, y);
    ctx.lineTo(x, y + 1.2 * r);
    ctx.lineTo(x - 1.2 * r, y);
    ctx.closePath();
  }
}

function paint(ctx: CanvasRenderingContext2D, marks: Marks, unit: number): void {
  ctx.lineWidth = 1.6 * unit;
  ctx.strokeStyle = marks.color;
  ctx.fillStyle = marks.hollow ? '#fff' : marks.color;
  ctx.fill();
  ctx.stroke();
}

function legend(box: HTMLElement, list: Marks[]): void {
  const row = document.createElement('div');
  row.className = 'legend';
  for (const marks of list) {
    const item = document.createElement('span');
    const canvas = document.createElement('canvas');
    canvas.width = canvas.height = 32;
    canvas.className = 'mark';
    const ctx = canvas.getContext('2d');
    if (ctx) {
      trace(ctx, marks.shape, 16, 16, 9);
      paint(ctx, marks, 2);
    }
    item.append(canvas, marks.label);
    row.append(item);
  }
  box.before(row);
}

export function buildDimensionPlot(box: HTMLElement, runs: Run[]): void {
  const list = marksOf(runs);
  if (list.length === 0) {
    box.textContent = 'The mesh was not changed.';
    return;
  }
  legend(box, list);
  const most = list.reduce((a, m) => m.points.reduce((b, p) => Math.max(b, p.dimension), a), 0);
  const last = runs[0].iterations - 1;
  const draw = (u: uPlot) => {
    const unit = devicePixelRatio * lineScale();
    u.ctx.save();
    for (const marks of list) {
      for (const point of marks.points) {
        trace(u.ctx, marks.shape, u.valToPos(point.iteration, 'x', true), u.valToPos(point.dimension, 'y', true), 4 * unit);
        paint(u.ctx, marks, unit);
      }
    }
    u.ctx.restore();
  };
  const plot = new uPlot(
    {
      mode: 2,
      width: box.clientWidth,
      height: box.clientHeight,
      padding: [fontSize(), fontSize(), 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: { x: { time: false, range: () => [0, last] }, y: { range: () => [0, most * 1.1] } },
      axes: [axis('Iteration', fontSize() * 2), axis('Order of ΔK', fontSize() * 3.2)],
      series: [{}, { facets: [{ scale: 'x', auto: true }, { scale: 'y', auto: true }], paths: () => null }],
      hooks: { draw: [draw] },
    } as uPlot.Options,
    [null, [[0, last], [0, most]]] as unknown as uPlot.AlignedData,
    box,
  );
  followWidth(box, plot);
}
