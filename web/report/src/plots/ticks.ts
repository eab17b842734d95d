// SPDX-License-Identifier: GPL-3.0-or-later
// Round numbers for axes.

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

/** At most `most` ticks of a logarithmic axis: 1, 2 and 5 times powers of ten if there is room, else powers of ten. */
export function logTicks(low: number, high: number, most: number): number[] {
  const fine = roundNumbers(low, high, [1, 2, 5]);
  const decades = roundNumbers(low, high, [1]);
  if (fine.length <= most || decades.length < 2) return fine;
  const every = Math.ceil(decades.length / most);
  return decades.filter((_, i) => i % every === 0);
}

/** Smallest and largest of all values, with room on both sides in parts of their distance. */
export function extent(arrays: ArrayLike<number>[], room: number): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const array of arrays) {
    for (let i = 0; i < array.length; i++) {
      low = Math.min(low, array[i]);
      high = Math.max(high, array[i]);
    }
  }
  if (!(high > low)) return [low - 1 || -1, high + 1 || 1];
  return [low - room * (high - low), high + room * (high - low)];
}
