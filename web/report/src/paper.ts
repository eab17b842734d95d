// SPDX-License-Identifier: GPL-3.0-or-later
// A page on paper: folded parts are open, and 3D pictures are stills as wide as the page.
import { element } from '../../shared/dom';

/** Opens folded parts while the page is printed. */
export function unfoldForPaper(): void {
  let opened: HTMLDetailsElement[] = [];
  addEventListener('beforeprint', () => {
    opened = [...document.querySelectorAll<HTMLDetailsElement>('details:not([open])')];
    for (const fold of opened) fold.open = true;
  });
  addEventListener('afterprint', () => {
    for (const fold of opened) fold.open = false;
  });
}

/** Puts a still in the place of a 3D picture while the page is printed: a canvas keeps the size of the screen. */
export function stillForPaper(picture: HTMLElement, still: () => string): void {
  const image = element('img', 'still');
  image.alt = '';
  addEventListener('beforeprint', () => {
    image.src = still();
    picture.prepend(image);
  });
  addEventListener('afterprint', () => image.remove());
}
