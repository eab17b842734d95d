// SPDX-License-Identifier: GPL-3.0-or-later
// Shows the step at the pointer: a dot on the curve and a small box with the values of this step.
import type uPlot from 'uplot';

export class Readout {
  private readonly box = document.createElement('div');
  private readonly dot = document.createElement('div');

  /** @param text returns the values of a step as HTML */
  constructor(private readonly plot: uPlot, private readonly text: (step: number) => string) {
    this.box.className = 'readout';
    this.dot.className = 'readout-dot';
    plot.over.append(this.dot, this.box);
    this.hide();
  }

  hide(): void {
    this.box.hidden = true;
    this.dot.hidden = true;
  }

  /** Shows step `i` at (x, y) on the plot's scales. */
  show(i: number, x: number, y: number): void {
    const { plot } = this;
    const left = plot.valToPos(x, 'x');
    const top = plot.valToPos(y, 'y');
    this.box.innerHTML = this.text(i);
    this.box.hidden = false;
    this.dot.hidden = false;
    this.dot.style.transform = `translate(${left}px, ${top}px)`;
    const width = plot.over.clientWidth;
    const beside = left + 14 + this.box.offsetWidth < width ? left + 14 : left - 14 - this.box.offsetWidth;
    const below = Math.max(0, Math.min(plot.over.clientHeight - this.box.offsetHeight, top - this.box.offsetHeight / 2));
    this.box.style.transform = `translate(${beside}px, ${below}px)`;
  }
}
