// SPDX-License-Identifier: GPL-3.0-or-later
import 'uplot/dist/uPlot.min.css';
import '../style.css';
import './style.css';
import { addLegend } from '../plots/series';
import { build } from '../page_part';
import { buildCumulative, buildDimensions, buildFigure5, buildForces, FORCES } from './charts';
import { decode } from './data';
import { drawContours, drawSegment, drawSurface } from './drawings';

document.documentElement.classList.add('with-script');
const data = decode(document.getElementById('reproduction-data')?.textContent ?? '');
build('figure5-plot', (b) => buildFigure5(b, data));
build('cumulative-plot', (b) => buildCumulative(b, data, false));
build('remeshing-plot', (b) => buildCumulative(b, data, true));
build('force-legend', (b) => addLegend(b, FORCES));
for (const run of data.runs) build(`forces-${run.id}`, (b) => buildForces(b, run, data.runs));
build('dimension-plot', (b) => buildDimensions(b, document.getElementById('dimension-legend') as HTMLElement, data.runs));
build('contours', (b) => drawContours(b, data.fig2));
build('surface', (b) => drawSurface(b, data.fig2));
build('segment', (b) => drawSegment(b, data.fig2.needle_segment.symmetric));
build('asymmetric', (b) => drawSegment(b, data.fig2.needle_segment.asymmetric));

