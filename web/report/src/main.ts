// SPDX-License-Identifier: GPL-3.0-or-later
import 'uplot/dist/uPlot.min.css';
import './style.css';
import { decode } from './data';
import { buildTemplatePictures } from './map/template_pictures';
import { Moment } from './moment';
import { buildCurvePlot, type CurveFamily } from './plots/curve_plot';
import { forceCurves } from './plots/force_curves';
import { glandCurves } from './plots/gland_curves';
import { buildHistogram } from './plots/histogram';
import { buildLegend, CurveChoice } from './plots/legend';
import { buildViewer } from './viewer/panel';
import { build } from './page_part';
import { unfoldForPaper } from './paper';

function box(id: string): HTMLElement {
  const element = document.getElementById(id);
  if (!element) throw new Error(`The page has no element "${id}"`);
  return element;
}

document.documentElement.classList.add('with-script');
unfoldForPaper();
const data = decode(box('report-data').textContent ?? '');
const moment = new Moment(data);

/** Builds the legend and both plots of a family of curves, in the boxes whose ids begin with `name`. */
function buildCurves(name: string, family: CurveFamily): void {
  const choice = new CurveChoice(family.curves);
  build(`${name}-legend`, (b) => buildLegend(b, choice));
  build(`${name}-depth`, (b) => buildCurvePlot(data, family, choice, moment, { box: b, abscissa: 'depth', label: 'Depth [mm]' }));
  build(`${name}-time`, (b) => buildCurvePlot(data, family, choice, moment, { box: b, abscissa: 'time', label: 'Time [s]' }));
}

buildCurves('force', forceCurves(data));
if (data.gland) buildCurves('gland', glandCurves(data, data.gland));
const { map } = data;
if (map) build('map-pictures', (b) => buildTemplatePictures(map, b));
build('step-times', (b) => buildHistogram(data, b));
build('viewer', (b) => buildViewer(data, moment, b));
