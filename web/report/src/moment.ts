// SPDX-License-Identifier: GPL-3.0-or-later
// The frame that all parts of the page show. Plots and viewer set it and listen to it.
import type { Frame, ReportData } from './data';

export class Moment {
  private readonly listeners: (() => void)[] = [];
  index: number;

  constructor(private readonly data: ReportData) {
    this.index = data.first_frame;
  }

  get frame(): Frame {
    return this.data.frames[this.index];
  }

  get count(): number {
    return this.data.frames.length;
  }

  set(index: number): void {
    const valid = Math.max(0, Math.min(this.count - 1, index));
    if (valid === this.index) return;
    this.index = valid;
    for (const listener of this.listeners) listener();
  }

  /** Goes to the frame nearest in time [s]. */
  setTime(time: number): void {
    let best = 0;
    this.data.frames.forEach((f, i) => {
      if (Math.abs(f.time_s - time) < Math.abs(this.data.frames[best].time_s - time)) best = i;
    });
    this.set(best);
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
}
