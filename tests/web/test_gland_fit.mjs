// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { peakAfter } from 'live/src/controls/key_figures';
import { GlandFit } from 'live/src/gland_fit';

// A block of two adjacent target regions in tissue. Their common face is inside the gland.
const points = Float32Array.from([0, 1, 2].flatMap((x) => [0, 1].flatMap((y) => [0, 1].flatMap((z) => [12 * x, 20 * y - 5, 30 * z]))));
const at = (x, y, z) => 4 * x + 2 * y + z;
const quad = (a, b, c, d) => [a, b, c, a, c, d];
const sides = (x) => [...quad(at(x, 0, 0), at(x + 1, 0, 0), at(x + 1, 0, 1), at(x, 0, 1)), ...quad(at(x, 1, 0), at(x, 1, 1), at(x + 1, 1, 1), at(x + 1, 1, 0)),
                      ...quad(at(x, 0, 0), at(x, 1, 0), at(x + 1, 1, 0), at(x + 1, 0, 0)), ...quad(at(x, 0, 1), at(x + 1, 0, 1), at(x + 1, 1, 1), at(x, 1, 1))];
const face = (x) => quad(at(x, 0, 0), at(x, 0, 1), at(x, 1, 1), at(x, 1, 0));
const left = [...sides(0), ...face(0)];
const right = [...sides(1), ...face(2)];
const scene = (target) => ({
  points, corners: Uint32Array.from([...left, ...right, ...face(1)]),
  regions: [{ target: false }, { target }, { target }],
  patches: [{ inside: 1, outside: 0, first: 0, count: 10 }, { inside: 0, outside: 2, first: 10, count: 10 }, { inside: 1, outside: 2, first: 20, count: 2 }],
});

test('a rigid motion of the gland is what is found', () => {
  const fit = GlandFit.of(scene(true));
  const unit = 1e-5;
  const [shift, turn] = [[0.03, -0.02, 0.05], [0.002, -0.001, 0.003]];
  const centre = [12, 5, 15];
  const u = Int16Array.from({ length: points.length }, (_, i) => {
    const node = i - (i % 3);
    const r = centre.map((c, k) => points[node + k] - c);
    const [a, b] = [(i + 1) % 3, (i + 2) % 3];
    return Math.round((shift[i % 3] + turn[a] * r[b] - turn[b] * r[a]) / unit);
  });
  fit.update(u, unit);
  fit.shift.forEach((value, k) => assert.ok(Math.abs(value - shift[k]) < 2e-5, `shift ${fit.shift}`));
  fit.rotation.forEach((value, k) => assert.ok(Math.abs(value - turn[k] * 180 / Math.PI) < 1e-3, `rotation ${fit.rotation}`));
});

test('without a target there is nothing to fit', () => {
  assert.equal(GlandFit.of(scene(false)), null);
});

test('the peak is the largest axial force of either sign since the whole curve came', () => {
  const frame = (whole, ...axial) => ({ whole, samples: Float32Array.from(axial.flatMap((f) => [0, 10, f, 5, 5, 40, 2, 0])) });
  assert.equal(peakAfter(0, frame(false, 1, -2, 1.5)), 2);
  assert.equal(peakAfter(3, frame(false, 1)), 3);
  assert.equal(peakAfter(3, frame(true, 1)), 1);
});
