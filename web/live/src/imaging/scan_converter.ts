// SPDX-License-Identifier: GPL-3.0-or-later
// Scan conversion: from the lines of an ultrasound picture to the pixels of the screen, with gain, time gain
// compensation and dynamic range.
import type { LiveUltrasound, Ultrasound } from './image';

/** A rectangle of the picture's plane [mm], and the pixels that show it. */
export interface Window { left: number; bottom: number; mmPerPixel: number; width: number; height: number }

export interface Tone {
  gain_dB: number;
  range_dB: number;   // from black to white
  tgc_dB: number[];   // gains from the near to the far end of a line
}

const BANDS = 24;     // along a line, with a table of grey levels each
const BLACK = 0xff000000;

/** The extent of a picture in its plane [mm]: left, right, bottom, top. */
export function extent(of: Ultrasound): [number, number, number, number] {
  if (of.sector_deg === 0) return [of.first_mm, of.first_mm + of.length_mm, of.radius_mm, of.radius_mm + of.depth_mm];
  const half = (Math.PI / 360) * of.sector_deg;
  const far = of.radius_mm + of.depth_mm;
  const side = far * Math.sin(Math.min(half, Math.PI / 2));
  return [-side, side, Math.min(0, far * Math.cos(half), of.radius_mm * Math.cos(half)), far];
}

/** The place along the lines (line 0 … 1, depth 0 … 1) of a point of the plane [mm]; null outside the picture. */
export function onLine(of: Ultrasound, u: number, v: number): [number, number] | null {
  let line: number;
  let depth: number;
  if (of.sector_deg === 0) {
    line = (u - of.first_mm) / of.length_mm;
    depth = (v - of.radius_mm) / of.depth_mm;
  } else {
    line = Math.atan2(u, v) / ((Math.PI / 180) * of.sector_deg) + 0.5;
    depth = (Math.hypot(u, v) - of.radius_mm) / of.depth_mm;
  }
  return line >= 0 && line <= 1 && depth >= 0 && depth <= 1 ? [line, depth] : null;
}

export class ScanConverter {
  private key = '';
  private pixel = new Uint32Array(0);   // pixels of the screen inside the picture
  private first = new Uint32Array(0);   // for each the value before it, on the line before it
  private line = new Float32Array(0);   // for each its distance from that line and that sample, in lines and samples
  private depth = new Float32Array(0);
  private band = new Uint8Array(0);
  private readonly grey = new Uint8Array(256 * BANDS);

  /** Draws a picture. @param out (width × height) ABGR */
  draw(image: LiveUltrasound, window: Window, tone: Tone, out: Uint32Array): void {
    this.prepare(image, window);
    this.setGrey(image, tone);
    out.fill(BLACK);
    const { pixel, first, line, depth, band, grey } = this;
    const { pixels, columns } = image;
    for (let i = 0; i < pixel.length; i++) {
      const at = first[i];
      const s = depth[i];
      const near = pixels[at] + s * (pixels[at + 1] - pixels[at]);
      const next = pixels[at + columns] + s * (pixels[at + columns + 1] - pixels[at + columns]);
      const value = (near + line[i] * (next - near) + 0.5) | 0;
      const level = grey[(band[i] << 8) | value];
      out[pixel[i]] = BLACK | (level << 16) | (level << 8) | level;
    }
  }

  private prepare(of: LiveUltrasound, window: Window): void {
    const key = [of.rows, of.columns, of.radius_mm, of.depth_mm, of.sector_deg, of.first_mm, of.length_mm, ...Object.values(window)].join();
    if (key === this.key) return;
    this.key = key;
    const most = window.width * window.height;
    const pixel = new Uint32Array(most);
    const first = new Uint32Array(most);
    const line = new Float32Array(most);
    const depth = new Float32Array(most);
    const band = new Uint8Array(most);
    let count = 0;
    for (let row = 0; row < window.height; row++) {
      const v = window.bottom + (window.height - 0.5 - row) * window.mmPerPixel;
      for (let column = 0; column < window.width; column++) {
        const place = onLine(of, window.left + (column + 0.5) * window.mmPerPixel, v);
        if (!place) continue;
        const l = Math.min(place[0] * (of.rows - 1), of.rows - 1.001);
        const d = Math.min(place[1] * (of.columns - 1), of.columns - 1.001);
        pixel[count] = row * window.width + column;
        first[count] = Math.floor(l) * of.columns + Math.floor(d);
        line[count] = l - Math.floor(l);
        depth[count] = d - Math.floor(d);
        band[count++] = Math.min(BANDS - 1, Math.floor(place[1] * BANDS));
      }
    }
    this.pixel = pixel.subarray(0, count);
    this.first = first.subarray(0, count);
    this.line = line.subarray(0, count);
    this.depth = depth.subarray(0, count);
    this.band = band.subarray(0, count);
  }

  /** The grey level of each value in each band of depths. White is 0 dB of the picture plus the gains. */
  private setGrey(of: Ultrasound, tone: Tone): void {
    for (let band = 0; band < BANDS; band++) {
      const place = ((band + 0.5) / BANDS) * (tone.tgc_dB.length - 1);
      const low = Math.min(Math.floor(place), tone.tgc_dB.length - 2);
      const tgc = tone.tgc_dB[low] + (place - low) * (tone.tgc_dB[low + 1] - tone.tgc_dB[low]);
      for (let value = 0; value < 256; value++) {
        const dB = of.range_dB * (value / 255 - 1) + tone.gain_dB + tgc;
        this.grey[256 * band + value] = Math.max(0, Math.min(255, 255 * (1 + dB / tone.range_dB)));
      }
    }
  }
}
