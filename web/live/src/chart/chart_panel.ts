// SPDX-License-Identifier: GPL-3.0-or-later
// The strip chart with its legend and the choice of the x axis.
import { element } from '../../../shared/dom';
import { CURVES } from '../../../shared/plot_style';
import type { Session } from '../session';
import { ForceChart } from './force_chart';

const SPANS: [string, number | null][] = [['10 s', 10], ['20 s', 20], ['60 s', 60], ['Depth', null]];

export function buildChart(root: HTMLElement, session: Session): ForceChart {
  const head = element('div', 'chart-head');
  const box = element('div', 'plot');
  root.append(head, box);
  const chart = new ForceChart(box, session);
  head.append(element('h2', '', 'Force on the base'));
  for (const curve of CURVES) {
    const b = element('button', 'curve', curve.label);
    b.type = 'button';
    b.style.setProperty('--curve', curve.color);
    b.setAttribute('aria-pressed', 'true');
    b.addEventListener('click', () => {
      if (!chart.shown.delete(curve.key)) chart.shown.add(curve.key);
      b.setAttribute('aria-pressed', String(chart.shown.has(curve.key)));
      chart.draw();
    });
    head.append(b);
  }
  const spans = element('div', 'spans');
  spans.setAttribute('role', 'group');
  spans.setAttribute('aria-label', 'What is on the x axis');
  const buttons = SPANS.map(([text, seconds]) => {
    const b = element('button', '', text);
    b.type = 'button';
    b.setAttribute('aria-pressed', String(seconds === chart.seconds));
    b.addEventListener('click', () => {
      if (seconds !== null) chart.seconds = seconds;
      chart.setByDepth(seconds === null);
      for (const other of buttons) other.setAttribute('aria-pressed', String(other === b));
    });
    return b;
  });
  spans.append(...buttons);
  head.append(spans);
  return chart;
}
