// SPDX-License-Identifier: GPL-3.0-or-later
// The colour map viridis (Smith & van der Walt 2015): ten samples with linear interpolation.
const SAMPLES: [number, number, number][] = [
  [0.267, 0.005, 0.329], [0.283, 0.157, 0.471], [0.244, 0.287, 0.537], [0.192, 0.408, 0.557], [0.149, 0.51, 0.557],
  [0.122, 0.62, 0.537], [0.208, 0.718, 0.475], [0.431, 0.808, 0.345], [0.71, 0.871, 0.169], [0.993, 0.906, 0.144],
];

/** Writes the sRGB colour of a value 0 … 1 to target[offset …]. */
export function viridis(share: number, target: Float32Array, offset: number): void {
  const at = Math.max(0, Math.min(1, share)) * (SAMPLES.length - 1);
  const low = Math.min(SAMPLES.length - 2, Math.floor(at));
  for (let k = 0; k < 3; k++) target[offset + k] = SAMPLES[low][k] + (SAMPLES[low + 1][k] - SAMPLES[low][k]) * (at - low);
}

export function viridisGradient(direction: string): string {
  const stops = SAMPLES.map((c) => `rgb(${c.map((v) => Math.round(255 * v)).join(',')})`);
  return `linear-gradient(${direction}, ${stops.join(',')})`;
}

/** Converts sRGB to linear values, with which three.js computes. */
export function toLinear(value: number): number {
  return value <= 0.04045 ? value / 12.92 : Math.pow((value + 0.055) / 1.055, 2.4);
}

/** The largest number not above `value` that is 1, 2 or 5 times a power of ten. */
export function roundDown(value: number): number {
  const power = Math.pow(10, Math.floor(Math.log10(value)));
  const leading = value / power;
  return power * (leading >= 5 ? 5 : leading >= 2 ? 2 : 1);
}
