// SPDX-License-Identifier: GPL-3.0-or-later
// The page of stylet dose: histograms, sections and the 3D view. The program writes the data in
// src/io/results/dose/page_data.cpp.
import 'uplot/dist/uPlot.min.css';
import '../style.css';
import '../verdict.css';
import './style.css';
import { build } from '../page_part';
import { decode } from './data';
import { buildDvhChart } from './dvh_chart';
import { buildLevelKey } from './level_look';
import { PLANES } from './planes';
import { buildSection } from './section_picture';
import { buildDoseViewer } from './viewer';

document.documentElement.classList.add('with-script');
const data = decode(document.getElementById('dose-data')?.textContent ?? '');
build('dvh-plot', (box) => buildDvhChart(data, box, document.getElementById('dvh-legend') as HTMLElement));
build('iso-key', (box) => buildLevelKey(data, box));
build('section-pictures', (box) => box.append(...PLANES.map((plane) => buildSection(data, plane))));
build('viewer', (box) => buildDoseViewer(data, box));
