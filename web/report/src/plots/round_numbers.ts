// SPDX-License-Identifier: GPL-3.0-or-later
// Ticks of logarithmic axes.
import type uPlot from 'uplot';
import { numberText } from '../../../shared/numbers';

/** The numbers between low and high that are a power of ten times one of `leading`. */
export function roundNumbers(low: number, high: number, leading: number[]): number[] {
  const numbers: number[] = [];
  for (let power = Math.floor(Math.log10(low)); Math.pow(10, power) <= high; power++) {
    for (const digit of leading) {
      const number = digit * Math.pow(10, power);
      if (number >= low && number <= high) numbers.push(number);
    }
  }
  return numbers;
}

/** An axis with ticks at exactly these numbers. By itself, uPlot leaves out some of them on a logarithmic axis. */
export function marksAt(numbers: number[], text: (value: number) => string = (v) => numberText(v)): Partial<uPlot.Axis> {
  return {
    splits: () => numbers,
    filter: (_u: uPlot, splits: number[]) => splits,
    values: (_u: uPlot, values: number[]) => values.map(text),
  };
}
