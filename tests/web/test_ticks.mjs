// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { extent, logTicks } from 'report/src/plots/ticks';

test('a logarithmic axis has 1, 2 and 5 where there is room, else powers of ten, else some of them', () => {
  assert.deepEqual(logTicks(3, 300, 8), [5, 10, 20, 50, 100, 200]);
  assert.deepEqual(logTicks(3, 3000, 5), [10, 100, 1000]);
  assert.deepEqual(logTicks(1, 1e6, 4), [1, 100, 1e4, 1e6]);
  assert.deepEqual(logTicks(2, 90, 1), [2, 5, 10, 20, 50], 'one power of ten alone would say nothing');
});

test('an axis has room beside its values, also where they are all the same', () => {
  assert.deepEqual(extent([[0, 4], [10]], 0.1), [-1, 11]);
  assert.deepEqual(extent([[3, 3]], 0.1), [2, 4]);
});
