// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { inPatient, inPlane, letters } from 'live/src/imaging/plane_axes';
import { extent, onLine, ScanConverter } from 'live/src/imaging/scan_converter';

const SECTOR = { radius_mm: 10, depth_mm: 50, sector_deg: 120, first_mm: 0, length_mm: 0, range_dB: 100, rows: 121, columns: 101 };
const LINEAR = { radius_mm: 10, depth_mm: 50, sector_deg: 0, first_mm: -30, length_mm: 60, range_dB: 100, rows: 61, columns: 101 };
const FLAT = { gain_dB: 0, range_dB: 100, tgc_dB: [0, 0, 0, 0] };

/** A picture whose value is a function of the place in the plane [mm]. */
function pictureOf(geometry, value) {
  const pixels = new Uint8Array(geometry.rows * geometry.columns);
  for (let line = 0; line < geometry.rows; line++) {
    for (let sample = 0; sample < geometry.columns; sample++) {
      const r = geometry.radius_mm + (sample / (geometry.columns - 1)) * geometry.depth_mm;
      const share = line / (geometry.rows - 1);
      const angle = ((share - 0.5) * geometry.sector_deg * Math.PI) / 180;
      const [u, v] = geometry.sector_deg > 0 ? [r * Math.sin(angle), r * Math.cos(angle)] : [geometry.first_mm + share * geometry.length_mm, r];
      pixels[line * geometry.columns + sample] = value(u, v);
    }
  }
  return { ...geometry, pixels };
}

test('each pixel of the screen shows what is there in the plane', () => {
  const value = (u, v) => Math.round(120 + 1.5 * u + 0.5 * v);
  for (const geometry of [SECTOR, LINEAR]) {
    const [left, right, bottom, top] = extent(geometry);
    const window = { left, bottom, mmPerPixel: 0.5, width: Math.ceil((right - left) / 0.5), height: Math.ceil((top - bottom) / 0.5) };
    const out = new Uint32Array(window.width * window.height);
    new ScanConverter().draw(pictureOf(geometry, value), window, FLAT, out);
    let inside = 0;
    for (let row = 0; row < window.height; row++) {
      for (let column = 0; column < window.width; column++) {
        const [u, v] = [left + 0.5 * (column + 0.5), bottom + 0.5 * (window.height - 0.5 - row)];
        const grey = out[row * window.width + column] & 255;
        if (onLine(geometry, u, v)) {
          inside++;
          assert.ok(Math.abs(grey - value(u, v)) <= 2, `${grey} at ${u}, ${v}`);
        } else assert.equal(grey, 0, 'black outside of the picture');
      }
    }
    const area = geometry.sector_deg > 0 ? ((Math.PI * geometry.sector_deg) / 360) * (60 ** 2 - 10 ** 2) : 50 * 60;
    assert.ok(Math.abs(0.25 * inside - area) < 0.02 * area, `${0.25 * inside} mm² of ${area}`);
  }
});

test('a gain brightens, a smaller range has more contrast, and time gain works by depth', () => {
  const window = { left: -30, bottom: 10, mmPerPixel: 1, width: 60, height: 50 };
  const levelAt = (tone, v, value = 128) => {
    const out = new Uint32Array(window.width * window.height);
    new ScanConverter().draw(pictureOf(LINEAR, () => value), window, tone, out);
    return out[Math.floor(60 - v) * window.width + 30] & 255;
  };
  assert.equal(levelAt(FLAT, 30), 128);
  // 128 is 49.8 dB below white.
  assert.ok(Math.abs(levelAt({ ...FLAT, gain_dB: 20 }, 30) - (128 + 51)) <= 1);
  assert.equal(levelAt({ ...FLAT, range_dB: 40 }, 30), 0);
  const near = { ...FLAT, tgc_dB: [20, 0, 0, 0] };
  assert.ok(levelAt(near, 12) > 170 && levelAt(near, 55) === 128);
});

test('a point of the patient and its place in the plane belong together', () => {
  const plane = { origin_mm: [1, 40, -3], right: [1, 0, 0], up: [0, -1, 0] };
  assert.deepEqual(inPlane(plane, [6, 30, 2]), [5, 10, -5], 'anterior is up, and superior is behind the screen');
  assert.deepEqual(inPatient(plane, 5, 10), [6, 30, -3]);
  assert.deepEqual(letters(plane.right), ['R', 'L']);
  assert.deepEqual(letters(plane.up), ['P', 'A']);
  assert.deepEqual(letters([0, 0.1, -0.9]), ['S', 'I']);
});
