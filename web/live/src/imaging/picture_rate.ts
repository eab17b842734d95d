// SPDX-License-Identifier: GPL-3.0-or-later
// How many different pictures were drawn in the last second, as scanners write it in a corner.
import { element } from '../../../shared/dom';

const WINDOW_MS = 1000;

export class PictureRate {
  private last: object | null = null;
  private times: number[] = [];  // [ms] when the newest pictures were drawn first

  /** Counts a picture that is drawn, unless it is the one that was drawn before. */
  drawn(picture: object, now_ms: number): void {
    if (picture === this.last) return;
    this.last = picture;
    this.times.push(now_ms);
    this.forget(now_ms);
  }

  /** Pictures per second. */
  perSecond(now_ms: number): number {
    this.forget(now_ms);
    return (this.times.length * 1000) / WINDOW_MS;
  }

  /** The rate in words; empty while pictures rest, since a new one is made only when something has moved. */
  text(now_ms: number): string {
    const rate = this.perSecond(now_ms);
    return rate < 2 ? '' : `${rate} pictures/s`;
  }

  private forget(now_ms: number): void {
    while (this.times.length > 0 && this.times[0] <= now_ms - WINDOW_MS) this.times.shift();
  }
}

/** The rate as an element over a corner of the picture. */
export class PictureRateLabel {
  readonly element = element('output', 'picture-rate');
  private readonly rate = new PictureRate();

  constructor() {
    this.element.title = 'Different pictures that were drawn in the last second. A new one is made when something has moved';
    setInterval(() => this.write(), WINDOW_MS / 4);
  }

  drawn(picture: object): void {
    this.rate.drawn(picture, performance.now());
  }

  private write(): void {
    const text = this.rate.text(performance.now());
    if (this.element.textContent !== text) this.element.textContent = text;
  }
}
