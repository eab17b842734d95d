// SPDX-License-Identifier: GPL-3.0-or-later
// A ring buffer of the steps of the last minute.
import { SAMPLE_WORDS, type Frame } from '../wire';

export const RING_STEPS = 60_000;
export const FORCES = ['axial', 'sagittal', 'lateral'] as const;
export type ForceName = (typeof FORCES)[number];

export class ForceRing {
  readonly time: Float64Array;    // [s]
  readonly depth: Float32Array;   // [mm]
  readonly axial: Float32Array;   // [N]
  readonly sagittal: Float32Array;
  readonly lateral: Float32Array;
  count = 0;       // stored steps
  total = 0;       // steps added since the last clear()
  private next = 0;

  constructor(readonly capacity = RING_STEPS) {
    this.time = new Float64Array(capacity);
    this.depth = new Float32Array(capacity);
    this.axial = new Float32Array(capacity);
    this.sagittal = new Float32Array(capacity);
    this.lateral = new Float32Array(capacity);
  }

  clear(): void {
    this.count = this.next = this.total = 0;
  }

  /** Adds the steps of a frame. Steps that are not later than the last stored one are dropped. */
  add(frame: Frame): void {
    const { samples } = frame;
    for (let i = 0; i < samples.length; i += SAMPLE_WORDS) {
      const time = frame.time + samples[i];
      if (this.count > 0 && time <= this.time[this.place(this.count - 1)]) continue;
      const to = this.next;
      this.time[to] = time;
      this.depth[to] = samples[i + 1];
      this.axial[to] = samples[i + 2];
      this.sagittal[to] = samples[i + 3];
      this.lateral[to] = samples[i + 4];
      this.next = (to + 1) % this.capacity;
      this.count = Math.min(this.count + 1, this.capacity);
      this.total++;
    }
  }

  /** Index in the arrays of the step with this number; number 0 is the oldest stored step. */
  place(number: number): number {
    return (this.next - this.count + number + this.capacity) % this.capacity;
  }

  /** Number of the first step that is not earlier than `time`. */
  since(time: number): number {
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.time[this.place(middle)] < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }
}

/**
 * Writes the numbers of the steps with the smallest and the largest value in [from, to) to `out`, the earlier first.
 */
export function extremes(ring: ForceRing, values: Float32Array, from: number, to: number, out: [number, number]): void {
  let low = from;
  let high = from;
  for (let i = from + 1; i < to; i++) {
    const value = values[ring.place(i)];
    if (value < values[ring.place(low)]) low = i;
    if (value > values[ring.place(high)]) high = i;
  }
  out[0] = Math.min(low, high);
  out[1] = Math.max(low, high);
}
