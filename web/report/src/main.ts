// SPDX-License-Identifier: GPL-3.0-or-later
import 'uplot/dist/uPlot.min.css';
import './style.css';
import { decode } from './data';
import { buildTemplatePictures } from './map/template_pictures';
import { Moment } from './moment';
import { buildCurveCharts, type CurveFamily } from './plots/curve_charts';
import { forceCurves, glandCurves } from './plots/curve_families';
import { buildHistogram } from './plots/histogram';
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

/** Builds the legend and both charts of a family of curves, in the boxes whose ids begin with `name`. */
function buildCurves(name: string, family: CurveFamily): void {
  build(`${name}-legend`, (legend) => buildCurveCharts(legend, box(`${name}-depth`), box(`${name}-time`), data, family, moment));
}

buildCurves('force', forceCurves(data));
if (data.gland) buildCurves('gland', glandCurves(data, data.gland));
const { map } = data;
if (map) build('map-pictures', (b) => buildTemplatePictures(map, b));
build('step-times', (b) => buildHistogram(data, b));
build('viewer', (b) => buildViewer(data, moment, b));
