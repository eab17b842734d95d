// SPDX-License-Identifier: GPL-3.0-or-later
// Where pictures come too slowly (no graphics hardware, a very large screen) they are drawn coarser, so that the hand,
// the sections and the curves keep up.

const TOO_SLOW_MS = 45;
const ONE_STREAM_MS = 600;  // longer between two pictures: nothing moved
const PICTURES = 12;        // before anything is concluded
const COARSEST = 0.5;

export class Pace {
  private last = 0;
  private sum = 0;
  private count = 0;

  /** @param ratio pixels of the picture for a CSS pixel */
  constructor(public ratio: number) {}

  /** Called with every picture. Returns whether `ratio` has changed. */
  tick(now: number): boolean {
    const gap = now - this.last;
    this.last = now;
    if (gap > ONE_STREAM_MS) return false;
    this.sum += gap;
    if (++this.count < PICTURES) return false;
    const slow = this.sum / this.count > TOO_SLOW_MS;
    this.sum = this.count = 0;
    if (!slow || this.ratio <= COARSEST) return false;
    this.ratio = Math.max(COARSEST, 0.75 * this.ratio);
    return true;
  }
}
