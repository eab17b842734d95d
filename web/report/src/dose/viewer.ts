// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view of a plan with the controls of its appearance.
import { element } from '../../../shared/dom';
import { openStage } from '../stage_box';
import type { DoseData } from './data';
import { DoseStage } from './stage';
import type { StructureShape } from './structure_shape';

export function switchOf(text: string, on: boolean, color: string | null, set: (on: boolean) => void): HTMLElement {
  const label = element('label');
  const box = element('input');
  box.type = 'checkbox';
  box.checked = on;
  box.addEventListener('change', () => set(box.checked));
  label.append(box);
  if (color) {
    const swatch = element('span', 'swatch');
    swatch.style.background = color;
    label.append(swatch);
  }
  label.append(text);
  return label;
}

function structureRow(shape: StructureShape, draw: () => void): HTMLElement {
  const row = element('div', 'region');
  const slider = element('input');
  slider.type = 'range';
  slider.min = '0';
  slider.max = '1';
  slider.step = '0.01';
  slider.value = String(shape.opacity);
  slider.setAttribute('aria-label', `Opacity of ${shape.structure.name}`);
  slider.addEventListener('input', () => {
    shape.opacity = slider.valueAsNumber;
    draw();
  });
  row.append(switchOf(shape.structure.name, shape.visible, shape.structure.color, (on) => {
    shape.visible = on;
    draw();
  }), slider);
  return row;
}

/** @param more adds to the picture and returns the controls of what it added */
export function buildDoseViewer(data: DoseData, root: HTMLElement, more?: (stage: DoseStage, picture: HTMLElement) => HTMLElement[]): void {
  const opened = openStage(root, (box, scaleBar) => new DoseStage(data, box, scaleBar), 'the 3D view needs.');
  if (!opened) return;
  const { stage, picture, views } = opened;
  const draw = () => stage.draw();
  const side = element('div', 'side');
  side.append(element('h3', '', 'Shown'), ...stage.structures.map((s) => structureRow(s, draw)),
    switchOf(data.sources.temporary ? 'Dwell positions' : 'Seeds', true, '#3b4452', (on) => {
      stage.sources.visible = on;
      draw();
    }),
    ...(more?.(stage, picture) ?? []),
    element('h3', '', 'View'), views, element('p', 'hint', 'Drag to turn, wheel to zoom, right button to move.'));
  root.append(side);
}
