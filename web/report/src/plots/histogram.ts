// SPDX-License-Identifier: GPL-3.0-or-later
// Histogram of the steps' times: bins of equal ratio, counts on a logarithmic scale so that rare slow steps are
// visible.
import type { ReportData } from '../data';
import { CURVES } from '../../../shared/plot_style';
import { Chart } from './chart';

export function buildHistogram({ histogram: { edges_us: edges, counts } }: ReportData, box: HTMLElement): void {
  if (counts.length === 0) {
    box.textContent = 'No step times were recorded.';
    return;
  }
  const [bars, limit] = [CURVES[0].color, CURVES[1].color];
  new Chart(box, {
    x: { label: 'Processor time of a step [µs]', log: true, range: [edges[0] / 1.15, Math.max(edges[edges.length - 1] * 1.15, 1200)] },
    y: { label: 'Steps', log: true, range: [0.7, 1.6 * Math.max(1, ...counts)] },
    series: [{ label: 'steps', color: bars, shape: 'bars', x: edges, y: counts }],
    rules: [{ x: 1000, color: limit, dashes: [5, 4], label: '1 kHz' }],
    follow: [],
  });
}
