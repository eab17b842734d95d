// SPDX-License-Identifier: GPL-3.0-or-later
// A minimal PNG reader, sufficient to check that a picture is not blank.
import { inflateSync } from 'node:zlib';

/** Reads a PNG with 8 bits per channel, RGB or RGBA. @returns width, height, at(x, y): [r, g, b] */
export function decodePng(bytes) {
  const width = bytes.readUInt32BE(16);
  const height = bytes.readUInt32BE(20);
  const channels = { 2: 3, 6: 4 }[bytes[25]];
  if (bytes[24] !== 8 || !channels) throw new Error(`PNG of ${bytes[24]} bits, colour type ${bytes[25]}`);
  const parts = [];
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) {
    if (bytes.toString('latin1', at + 4, at + 8) === 'IDAT') parts.push(bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at)));
  }
  const raw = inflateSync(Buffer.concat(parts));
  const row = width * channels;
  const pixels = Buffer.alloc(row * height);
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (row + 1)];
    for (let x = 0; x < row; x++) {
      const left = x >= channels ? pixels[y * row + x - channels] : 0;
      const up = y > 0 ? pixels[(y - 1) * row + x] : 0;
      const corner = x >= channels && y > 0 ? pixels[(y - 1) * row + x - channels] : 0;
      const guess = [0, left, up, (left + up) >> 1, paeth(left, up, corner)][filter];
      pixels[y * row + x] = raw[y * (row + 1) + 1 + x] + guess;
    }
  }
  return { width, height, at: (x, y) => [...pixels.subarray(y * row + x * channels, y * row + x * channels + 3)] };
}

function paeth(a, b, c) {
  const [da, db, dc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
  return da <= db && da <= dc ? a : db <= dc ? b : c;
}

/** Number of different colours in the parts of a saved picture: 3D view and sections above, curve below. */
export function shadesOf(bytes) {
  const { width, height, at } = decodePng(bytes);
  const count = (x0, x1, y0, y1) => {
    const seen = new Set();
    for (let y = Math.round(y0 * height); y < y1 * height; y += 2) {
      for (let x = Math.round(x0 * width); x < x1 * width; x += 2) seen.add(at(x, y).join());
    }
    return seen.size;
  };
  return { width, height, shades: { view: count(0.02, 0.55, 0.12, 0.65), sections: count(0.62, 0.98, 0.12, 0.65), curve: count(0.02, 0.98, 0.72, 0.94) } };
}
