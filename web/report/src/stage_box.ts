// SPDX-License-Identifier: GPL-3.0-or-later
import { button, element } from '../../shared/dom';
import type { BaseStage } from '../../shared/stage';
import { VIEWS } from '../../shared/views';
import { stillForPaper } from './paper';

/** Makes a view in a box. @param scaleBar as for BaseStage */
type Make<Kind> = (box: HTMLElement, scaleBar: (mm: number, px: number) => void) => Kind;

/**
 * Puts the picture of a 3D view into the page.
 * @param without what is said where there is no WebGL
 * @returns the view, its picture, and buttons for the standard views; null without WebGL
 */
export function openStage<Kind extends BaseStage>(root: HTMLElement, make: Make<Kind>, without: string): { stage: Kind; picture: HTMLElement; views: HTMLElement } | null {
  const picture = element('div', 'picture');
  const canvas = element('div', 'canvas');
  const bar = element('div', 'scale-bar');
  picture.append(canvas, bar);
  root.append(picture);
  let stage: Kind;
  try {
    stage = make(canvas, (mm, px) => {
      bar.textContent = `${mm} mm`;
      bar.style.width = `${(100 * px) / picture.clientWidth}%`;
    });
  } catch {
    root.replaceChildren(element('p', 'note', `This browser offers no WebGL, which ${without}`));
    return null;
  }
  stillForPaper(picture, () => stage.still());
  const views = element('div', 'views');
  for (const { name, from } of VIEWS) views.append(button(name === 'Oblique' ? 'Reset view' : name, () => stage.look(from)));
  return { stage, picture, views };
}
