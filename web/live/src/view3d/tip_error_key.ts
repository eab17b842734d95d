// SPDX-License-Identifier: GPL-3.0-or-later
// The legend of the marks of the tip error.
import { element } from '../../../shared/dom';
import { drawCross, drawRing } from '../tip_error_shapes';

const SIZE_PX = 48;  // size of the picture, which is shown as large as the text

export function tipErrorKey(): HTMLElement {
  const key = element('div', 'contact-key');
  for (const [draw, text] of [[drawCross, 'planned'], [drawRing, 'reached']] as const) {
    const mark = element('canvas', 'mark');
    mark.width = mark.height = SIZE_PX;
    draw(mark.getContext('2d') as CanvasRenderingContext2D, [SIZE_PX / 2, SIZE_PX / 2], 0.4 * SIZE_PX);
    const item = element('span');
    item.append(mark, text);
    key.append(item);
  }
  return key;
}
