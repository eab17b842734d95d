// SPDX-License-Identifier: GPL-3.0-or-later
// The page of stylet dose. The program writes the data in src/io/results/dose/page_data.cpp.
import 'uplot/dist/uPlot.min.css';
import '../style.css';
import '../verdict.css';
import './style.css';
import { decode } from './data';
import { buildDosePage } from './page';

buildDosePage(decode(document.getElementById('dose-data')?.textContent ?? ''));
