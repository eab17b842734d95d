// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Pace } from 'live/src/view3d/pace';

function run(pace, gap, pictures) {
  let now = 1e6;
  for (let i = 0; i < pictures; i++) pace.tick((now += gap));
}

test('pictures that come in time stay as fine as they are', () => {
  const pace = new Pace(2);
  run(pace, 17, 1000);
  assert.equal(pace.ratio, 2);
});

test('pictures that come too slowly get coarser, to half a pixel at most', () => {
  const pace = new Pace(2);
  run(pace, 100, 30);
  assert.ok(pace.ratio < 2);
  run(pace, 100, 1000);
  assert.equal(pace.ratio, 0.5);
});

test('a view in which nothing moves is not slow', () => {
  const pace = new Pace(1);
  run(pace, 5000, 100);
  assert.equal(pace.ratio, 1);
});
