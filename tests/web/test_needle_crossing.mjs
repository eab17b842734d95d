// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { crossing, tipOf } from 'live/src/sections/needle_crossing';

const line = Float32Array.of(0, 0, -100, 0, 0, 0, 4, 2, 10);

test('the needle crosses a plane between two of its points in proportion', () => {
  const out = new Float32Array(3);
  assert.ok(crossing(line, 2, 5, out));
  assert.deepEqual([...out], [2, 1, 5]);
});

test('a plane beyond the tip is not crossed', () => {
  assert.equal(crossing(line, 2, 11, new Float32Array(3)), false);
});

test('the tip is the end of the centreline, or what the frame says where there is none', () => {
  const tip = Float32Array.of(7, 8, 9);
  assert.deepEqual([...tipOf({ line, tip }, new Float32Array(3))], [4, 2, 10]);
  assert.deepEqual([...tipOf({ line: new Float32Array(0), tip }, new Float32Array(3))], [7, 8, 9]);
});
