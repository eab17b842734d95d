// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { extremes, ForceRing } from 'live/src/chart/force_ring';

const frame = (time, steps) => ({ time, samples: Float32Array.from(steps.flatMap(([t, axial]) => [t, 10, axial, 0, 0, 40, 2, 0])) });

test('keeps the newest steps when it is full, in order', () => {
  const ring = new ForceRing(5);
  for (let i = 0; i < 4; i++) ring.add(frame(2 * i + 1, [[-1, 2 * i], [0, 2 * i + 1]]));
  assert.equal(ring.count, 5);
  assert.equal(ring.total, 8);
  assert.deepEqual([0, 1, 2, 3, 4].map((i) => ring.time[ring.place(i)]), [3, 4, 5, 6, 7]);
  assert.deepEqual([0, 1, 2, 3, 4].map((i) => ring.axial[ring.place(i)]), [3, 4, 5, 6, 7]);
});

test('drops steps that it already has', () => {
  const ring = new ForceRing(10);
  ring.add(frame(1, [[-0.5, 1], [0, 2]]));
  ring.add(frame(1.5, [[-1, 9], [-0.5, 9], [0, 3]]));
  assert.deepEqual([0, 1, 2].map((i) => ring.axial[ring.place(i)]), [1, 2, 3]);
  assert.equal(ring.count, 3);
});

test('finds the first step since a time', () => {
  const ring = new ForceRing(4);
  ring.add(frame(5, [[-5, 0], [-4, 0], [-3, 0], [-2, 0], [-1, 0], [0, 0]]));
  assert.equal(ring.since(-1), 0);
  assert.equal(ring.since(3.5), 2);
  assert.equal(ring.since(9), 4);
});

test('the extremes of a stretch are its smallest and largest step, the earlier first', () => {
  const ring = new ForceRing(8);
  ring.add(frame(6, [[-6, 0], [-5, 3], [-4, 1], [-3, -2], [-2, 1], [-1, 0], [0, 0]]));
  const out = [0, 0];
  extremes(ring, ring.axial, 0, 7, out);
  assert.deepEqual(out, [1, 3]);
  extremes(ring, ring.axial, 4, 7, out);
  assert.deepEqual(out, [4, 5]);
});
