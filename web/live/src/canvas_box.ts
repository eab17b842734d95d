// SPDX-License-Identifier: GPL-3.0-or-later
// A canvas that fills its box and is sharp on every screen. It is drawn at most once per repaint of the page.
import { onRepaint } from '../../shared/repaint';

export class CanvasBox {
  readonly canvas = document.createElement('canvas');
  readonly context: CanvasRenderingContext2D;
  width = 0;       // [CSS px]
  height = 0;      // [CSS px]
  text = 12;       // size of text [CSS px]
  family = 'sans-serif';

  /** @param draw draws the whole picture; the context is empty and scaled to CSS px */
  constructor(private readonly box: HTMLElement, private readonly draw: () => void) {
    const context = this.canvas.getContext('2d');
    if (!context) throw new Error('This browser does not support 2D canvas drawing');
    this.context = context;
    box.append(this.canvas);
    new ResizeObserver(() => this.resize()).observe(box);  // the first call comes soon, but after the constructor
  }

  /** Requests a new picture for the next repaint. */
  readonly request = onRepaint(() => this.render());

  render(): void {
    if (this.width === 0 || this.height === 0) return;
    this.context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    this.context.clearRect(0, 0, this.width, this.height);
    this.draw();
  }

  font(scale = 1, weight = 400): string {
    return `${weight} ${(this.text * scale).toFixed(1)}px ${this.family}`;
  }

  private resize(): void {
    this.width = this.box.clientWidth;
    this.height = this.box.clientHeight;
    this.canvas.width = Math.round(this.width * devicePixelRatio);
    this.canvas.height = Math.round(this.height * devicePixelRatio);
    const style = getComputedStyle(this.box);
    this.text = parseFloat(style.fontSize);
    this.family = style.fontFamily;
    this.render();
  }
}
