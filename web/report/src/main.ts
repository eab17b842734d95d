// SPDX-License-Identifier: GPL-3.0-or-later
import 'uplot/dist/uPlot.min.css';
import './style.css';
import { decode } from './data';
import { Moment } from './moment';
import { buildForcePlot } from './plots/force_plot';
import { buildHistogram } from './plots/histogram';
import { buildLegend, CurveChoice } from './plots/legend';
import { buildViewer } from './viewer/panel';

function box(id: string): HTMLElement {
  const element = document.getElementById(id);
  if (!element) throw new Error(`The page has no element "${id}"`);
  return element;
}

document.documentElement.classList.add('with-script');
const data = decode(box('report-data').textContent ?? '');
const moment = new Moment(data);
const choice = new CurveChoice();
buildLegend(box('force-legend'), choice);
buildForcePlot(data, choice, moment, { box: box('force-depth'), abscissa: 'depth', label: 'Depth [mm]' });
buildForcePlot(data, choice, moment, { box: box('force-time'), abscissa: 'time', label: 'Time [s]' });
buildHistogram(data, box('step-times'));
buildViewer(data, moment, box('viewer'));
