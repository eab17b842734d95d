// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a page that show a dose: histograms, sections and the 3D view.
import { build } from '../page_part';
import type { DoseData } from './data';
import { buildDifferenceKey } from './difference';
import { buildDvhChart } from './dvh_chart';
import { buildLevelKey } from './level_look';
import { PLANES } from './planes';
import { buildSection, type MoreMarks } from './section_picture';
import type { DoseStage } from './stage';
import { buildDoseViewer } from './viewer';

/** Content of a page beside the dose. */
export interface More {
  planned?: number[][];       // (structures × doses) histograms of a plan [%]
  found?: number[][];         // those of seeds that were found on images
  keys?: [string, string][];  // further marks of the sections as SVG, with their names
  marks?: MoreMarks;
  inSpace?: (stage: DoseStage, picture: HTMLElement) => HTMLElement[];
}

export function buildDosePage(data: DoseData, more: More = {}): void {
  document.documentElement.classList.add('with-script');
  build('dvh-plot', (box) => buildDvhChart(data, box, document.getElementById('dvh-legend') as HTMLElement, more.planned, more.found));
  build('iso-key', (box) => buildLevelKey(data, box, more.keys));
  build('section-pictures', (box) => box.append(...PLANES.map((plane) => buildSection(data, plane, more.marks))));
  if (data.difference && document.getElementById('difference-pictures')) {
    build('difference-key', (box) => buildDifferenceKey(data, box));
    build('difference-pictures', (box) => box.append(...PLANES.map((plane) => buildSection(data, plane, undefined, true))));
  }
  build('viewer', (box) => buildDoseViewer(data, box, more.inSpace));
}
