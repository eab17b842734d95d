// SPDX-License-Identifier: GPL-3.0-or-later
// The arrows of the seeds' errors in the 3D view, the seeds found on images, and needles that are in the tissue
// together, with their controls.
import { element, switchOf } from '../../../shared/dom';
import type { DoseStage } from '../dose/stage';
import { capital, type ImplantData } from './data';
import { ErrorArrows } from './error_arrows';
import { FOUND_COLOR, foundMarks } from './found_marks';
import { NEEDLE_COLOR, needleShafts, STABILISING_COLOR } from './needle_shafts';

const TIMES = 3;

function swatchOf(color: string): HTMLElement {
  const swatch = element('i', 'swatch');
  swatch.style.background = color;
  return swatch;
}

/** A switch for the seeds that were found on images, where there are any. */
function addFound({ found }: ImplantData, stage: DoseStage): HTMLElement[] {
  if (!found) return [];
  const marks = foundMarks(found);
  stage.add(marks);
  return [
    switchOf('Found on imaging', true, FOUND_COLOR, (on) => {
      marks.visible = on;
      stage.draw();
    }),
  ];
}

/** Switches for the needles that are in the tissue together, where there are any. */
function addNeedles({ nouns, needles, needle_diameter_mm: diameter }: ImplantData, stage: DoseStage): HTMLElement[] {
  const kinds = [
    { text: 'Stabilising needles', color: STABILISING_COLOR, of: needles.filter((needle) => needle.stabilises) },
    { text: `${capital(nouns.needles)} of the plan`, color: NEEDLE_COLOR, of: needles.filter((needle) => !needle.stabilises) },
  ].filter(({ of }) => of.length > 0);
  if (kinds.length === 0) return [];
  return [
    element('h3', '', `${capital(nouns.needles)} in place together`),
    ...kinds.map(({ text, color, of }) => {
      const shafts = needleShafts(of, diameter, color);
      stage.add(shafts);
      return switchOf(text, true, color, (on) => {
        shafts.visible = on;
        stage.draw();
      });
    }),
  ];
}

export function addArrows(data: ImplantData, stage: DoseStage, picture: HTMLElement): HTMLElement[] {
  const arrows = new ErrorArrows(data);
  stage.add(arrows.object);
  const note = element('div', 'exaggeration', `The arrows are drawn ${TIMES} times as long as the errors.`);
  note.hidden = true;
  picture.append(note);
  let long = false;
  const update = () => {
    note.hidden = !long || !arrows.object.visible;
    stage.draw();
  };
  const key = element('div', 'arrow-key');
  for (const { name, color } of data.thirds) {
    const part = element('span');
    part.append(swatchOf(color), name);
    key.append(part);
  }
  return [
    element('h3', '', `Errors of the ${data.nouns.sources}`),
    switchOf('Arrows from planned to rest', true, null, (on) => {
      arrows.object.visible = on;
      update();
    }),
    switchOf(`${TIMES} times as long`, false, null, (on) => {
      long = on;
      arrows.stretch(on ? TIMES : 1);
      update();
    }),
    key,
    ...addFound(data, stage),
    ...addNeedles(data, stage),
  ];
}
