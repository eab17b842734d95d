// SPDX-License-Identifier: GPL-3.0-or-later
import 'uplot/dist/uPlot.min.css';
import './style.css';
import { decode } from './data';
import { Moment } from './moment';
import { buildForcePlot } from './plots/force_plot';
import { buildHistogram } from './plots/histogram';
import { buildLegend, CurveChoice } from './plots/legend';
import { buildViewer } from './viewer/panel';
import { build } from './page_part';

function box(id: string): HTMLElement {
  const element = document.getElementById(id);
  if (!element) throw new Error(`The page has no element "${id}"`);
  return element;
}

document.documentElement.classList.add('with-script');
const data = decode(box('report-data').textContent ?? '');
const moment = new Moment(data);
const choice = new CurveChoice();
build('force-legend', (b) => buildLegend(b, choice));
build('force-depth', (b) => buildForcePlot(data, choice, moment, { box: b, abscissa: 'depth', label: 'Depth [mm]' }));
build('force-time', (b) => buildForcePlot(data, choice, moment, { box: b, abscissa: 'time', label: 'Time [s]' }));
build('step-times', (b) => buildHistogram(data, b));
build('viewer', (b) => buildViewer(data, moment, b));
