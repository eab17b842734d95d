// SPDX-License-Identifier: GPL-3.0-or-later
// The page of stylet implant: histograms of both doses, sections and the 3D view with the errors of the seeds. The
// program writes the data in src/io/results/dose/page_data.cpp and src/io/results/implant/implant_data.cpp.
import 'uplot/dist/uPlot.min.css';
import '../style.css';
import '../verdict.css';
import '../dose/style.css';
import './style.css';
import { decode } from '../dose/data';
import { buildDosePage } from '../dose/page';
import { addArrows } from './arrow_controls';
import { buildImplantCharts } from './charts';
import { decodeImplant } from './data';
import { ERROR_KEY, errorMarks, FOUND_KEY, PLANNED_KEY } from './error_marks';

const text = (id: string) => document.getElementById(id)?.textContent ?? '';
const implant = decodeImplant(text('implant-data'));
buildDosePage(decode(text('dose-data')), {
  planned: implant.planned_percent,
  found: implant.found_percent,
  keys: [
    [PLANNED_KEY, 'planned place'],
    [ERROR_KEY, `error of a ${implant.nouns.source}`],
    ...(implant.found ? [[FOUND_KEY, 'found on imaging'] as [string, string]] : []),
  ],
  marks: errorMarks(implant),
  inSpace: (stage, picture) => addArrows(implant, stage, picture),
});
buildImplantCharts(implant);
