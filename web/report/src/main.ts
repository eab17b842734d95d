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

/** Builds one part of the page; when that fails the others still work, and the reader is told. */
function build(id: string, part: (element: HTMLElement) => void): void {
  const element = box(id);
  try {
    part(element);
  } catch (error) {
    const note = document.createElement('p');
    note.className = 'note';
    note.textContent = `This part could not be shown: ${error instanceof Error ? error.message : String(error)}`;
    element.replaceChildren(note);
  }
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
