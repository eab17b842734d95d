// SPDX-License-Identifier: GPL-3.0-or-later
// If pictures take too long (no graphics hardware, a very large screen), the 3D view is drawn with a lower resolution,
// so that the hand, the sections and the curves stay responsive.

const TOO_SLOW_MS = 45;
const ONE_STREAM_MS = 600;  // a longer time between two pictures means that nothing moved
const PICTURES = 12;        // number of pictures for one decision
const COARSEST = 0.5;

export class Pace {
  private last = 0;
  private sum = 0;
  private count = 0;

  /** @param ratio pixels of the picture per CSS pixel */
  constructor(public ratio: number) {}

  /** Must be called with every picture. Returns whether `ratio` has changed. */
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
