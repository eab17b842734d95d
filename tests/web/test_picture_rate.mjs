// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { PictureRate } from 'live/src/imaging/picture_rate';

test('pictures that were drawn in the last second are counted once each', () => {
  const rate = new PictureRate();
  assert.equal(rate.text(0), '');
  for (let k = 0; k < 50; k++) {
    const picture = {};
    rate.drawn(picture, 40 * k);
    rate.drawn(picture, 40 * k + 16);  // the same one again, at the next repaint
  }
  assert.equal(rate.perSecond(1960), 25);
  assert.equal(rate.text(1960), '25 pictures/s');
});

test('the rate falls to nothing when no more pictures come', () => {
  const rate = new PictureRate();
  for (let k = 0; k < 20; k++) rate.drawn({}, 50 * k);
  assert.equal(rate.perSecond(1449), 11);
  assert.equal(rate.text(2000), '');
});
