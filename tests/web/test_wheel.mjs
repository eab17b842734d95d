// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { wheelNotches } from 'live/src/wheel';

const turn = (deltaY, more = {}) => wheelNotches({ deltaX: 0, deltaY, deltaMode: 0, shiftKey: false, ...more });

test('a notch is a notch in every browser, several in one event are several', () => {
  for (const pixels of [100, 114, 120]) assert.equal(turn(-pixels), 1);
  assert.equal(turn(3, { deltaMode: 1 }), -1);
  assert.equal(turn(-500), 5);
  assert.equal(turn(0, { deltaX: 100, shiftKey: true }), -0.1);
});

test('a touchpad, which speaks in pixels, moves by as much as the finger', () => {
  assert.equal(turn(-4), 0.04);
  assert.equal(turn(0), 0);
});
