// SPDX-License-Identifier: GPL-3.0-or-later
// Histogram of the steps' times: bins of equal ratio, counts on a logarithmic scale so that rare slow steps are
// visible.
import uPlot from 'uplot';
import type { ReportData } from '../data';
import { marksAt, roundNumbers } from './round_numbers';
import { axis, CURVES, followWidth, fontSize } from '../../../shared/plot_style';

export function buildHistogram(data: ReportData, box: HTMLElement): void {
  const { edges_us: edges, counts } = data.histogram;
  if (counts.length === 0) {
    box.textContent = 'No step times were recorded.';
    return;
  }
  const low = edges[0] / 1.15;
  const high = Math.max(edges[edges.length - 1] * 1.15, 1200);
  const most = counts.reduce((a, b) => Math.max(a, b), 1);
  const bars = (u: uPlot) => {
    const { ctx } = u;
    const floor = u.bbox.top + u.bbox.height;
    ctx.save();
    ctx.fillStyle = CURVES[0].color;
    counts.forEach((count, bin) => {
      if (count === 0) return;
      const left = u.valToPos(edges[bin], 'x', true);
      const right = u.valToPos(edges[bin + 1], 'x', true);
      const top = u.valToPos(count, 'y', true);
      ctx.fillRect(left + 0.5, top, Math.max(1, right - left - 1), floor - top);
    });
    ctx.restore();
    return null;
  };
  const limit = (u: uPlot) => {
    const { ctx, bbox } = u;
    const ratio = devicePixelRatio;
    const x = u.valToPos(1000, 'x', true);
    if (x < bbox.left || x > bbox.left + bbox.width) return;
    ctx.save();
    ctx.strokeStyle = CURVES[1].color;
    ctx.lineWidth = 1.5 * ratio;
    ctx.setLineDash([5 * ratio, 4 * ratio]);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.font = `${fontSize() * ratio}px ${getComputedStyle(document.body).fontFamily}`;
    ctx.fillStyle = CURVES[1].color;
    ctx.textAlign = 'right';
    ctx.fillText('1 kHz', x - 6 * ratio, bbox.top + fontSize() * ratio);
    ctx.restore();
  };
  const plot = new uPlot(
    {
      mode: 2,
      width: box.clientWidth,
      height: box.clientHeight,
      padding: [fontSize(), fontSize(), 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: false, distr: 3, range: () => [low, high] },
        y: { distr: 3, range: () => [0.7, most * 1.6] },
      },
      axes: [
        { ...axis('Processor time of a step [µs]', fontSize() * 2), ...marksAt(roundNumbers(low, high, [1, 2, 5])) },
        { ...axis('Steps', fontSize() * 4.2), ...marksAt(roundNumbers(0.7, most * 1.6, [1])) },
      ],
      series: [{}, { facets: [{ scale: 'x', auto: true }, { scale: 'y', auto: true }], paths: bars }],
      hooks: { draw: [limit] },
    } as uPlot.Options,
    [null, [edges.slice(0, -1), counts]] as unknown as uPlot.AlignedData,
    box,
  );
  followWidth(box, plot);
}
