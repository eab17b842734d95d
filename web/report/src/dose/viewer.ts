// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view of a plan with the controls of its appearance.
import { element, switchOf } from '../../../shared/dom';
import { regionRow } from '../../../shared/region_look';
import { openStage } from '../stage_box';
import type { DoseData } from './data';
import { DoseStage } from './stage';

/** @param more adds to the picture and returns the controls of what it added */
export function buildDoseViewer(data: DoseData, root: HTMLElement, more?: (stage: DoseStage, picture: HTMLElement) => HTMLElement[]): void {
  const opened = openStage(root, (box, scaleBar) => new DoseStage(data, box, scaleBar), 'the 3D view needs.');
  if (!opened) return;
  const { stage, picture, views } = opened;
  const draw = () => stage.draw();
  const side = element('div', 'side');
  side.append(element('h3', '', 'Shown'), ...stage.structures.map((shape) => regionRow(shape, shape.structure.name, shape.structure.color, draw)),
    switchOf(data.sources.temporary ? 'Dwell positions' : 'Seeds', true, '#3b4452', (on) => {
      stage.sources.visible = on;
      draw();
    }),
    ...(more?.(stage, picture) ?? []),
    element('h3', '', 'View'), views, element('p', 'hint', 'Drag to turn, wheel to zoom, right button to move.'));
  root.append(side);
}
