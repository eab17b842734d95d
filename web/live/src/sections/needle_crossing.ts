// SPDX-License-Identifier: GPL-3.0-or-later

/** Writes the end of the needle's centreline to `out` (3); the frame's tip if there is no centreline. */
export function tipOf(frame: { line: Float32Array; tip: Float32Array }, out: Float32Array): Float32Array {
  const { line, tip } = frame;
  for (let k = 0; k < 3; k++) out[k] = line.length >= 3 ? line[line.length - 3 + k] : tip[k];
  return out;
}

/** Writes the point at which a line crosses the plane `axis` = `value` to `out` (3). False if it does not cross it. */
export function crossing(line: Float32Array, axis: number, value: number, out: Float32Array): boolean {
  for (let i = 3; i < line.length; i += 3) {
    const a = line[i - 3 + axis];
    const b = line[i + axis];
    if ((a - value) * (b - value) > 0 || a === b) continue;
    const share = (value - a) / (b - a);
    for (let k = 0; k < 3; k++) out[k] = line[i - 3 + k] + share * (line[i + k] - line[i - 3 + k]);
    return true;
  }
  return false;
}
