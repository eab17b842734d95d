// SPDX-License-Identifier: GPL-3.0-or-later
// The arrows of the seeds' errors in the 3D view, and the seeds found on images, with their controls.
import { element } from '../../../shared/dom';
import type { DoseStage } from '../dose/stage';
import { switchOf } from '../dose/viewer';
import type { ImplantData } from './data';
import { ErrorArrows } from './error_arrows';
import { FOUND_COLOR, foundMarks } from './found_marks';

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
    element('h3', '', 'Errors of the seeds'),
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
  ];
}
