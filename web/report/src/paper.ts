// SPDX-License-Identifier: GPL-3.0-or-later
// A page on paper: folded parts are open, charts are as wide as the paper, and 3D pictures are stills, because a canvas
// keeps the size that it has on the screen.
import { element } from '../../shared/dom';

const charts: (() => void)[] = [];
let printing = false;
let opened: HTMLDetailsElement[] = [];

/** @param draw draws a canvas with the size of its box and of the page's text: now, for other widths, and for paper */
export function drawToFit(box: HTMLElement, draw: () => void): void {
  let width = box.clientWidth;
  new ResizeObserver(() => {
    if (printing || box.clientWidth === width) return;
    width = box.clientWidth;
    draw();
  }).observe(box);
  charts.push(draw);
  draw();
}

addEventListener('beforeprint', () => {
  printing = true;
  opened = [...document.querySelectorAll<HTMLDetailsElement>('details:not([open])')];
  for (const fold of opened) fold.open = true;
  const { classList } = document.documentElement;
  classList.add('on-paper');  // makes the page as wide as paper, and three times as large so that charts are fine
  for (const draw of charts) draw();
  queueMicrotask(() => classList.remove('on-paper'));  // uPlot draws in microtasks, which are done before
});

addEventListener('afterprint', () => {
  printing = false;
  for (const fold of opened) fold.open = false;
  for (const draw of charts) draw();
});

/** Puts a still in the place of a 3D picture while the page is printed. */
export function stillForPaper(picture: HTMLElement, still: () => string): void {
  const image = element('img', 'still');
  image.alt = '';
  addEventListener('beforeprint', () => {
    image.src = still();
    picture.prepend(image);
  });
  addEventListener('afterprint', () => image.remove());
}
