// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { tipErrorText } from 'live/src/controls/key_figures';
import { hasTipError, isDrawnBack, makeEnds, tipErrorEnds } from 'live/src/tip_error';

const f32 = (...values) => Float32Array.of(...values);
const NONE = f32(NaN, NaN, NaN);

function frame({ error = f32(0.1, -0.3, -2.5), depth = 66, of = 66 } = {}) {
  return { depth, tipError: error, tipErrorDepth: of, base: f32(10, 5, -180), orientation: f32(1, 0, 0, 0) };
}

test('outside the tissue there is no error', () => {
  const outside = frame({ error: NONE, of: NaN });
  assert.equal(hasTipError(outside), false);
  assert.deepEqual(tipErrorText(outside), { text: '–', title: 'Not known: the tip is not in the tissue' });
});

test('the number is the length of the error, its parts are said by their anatomical directions', () => {
  const { text, title } = tipErrorText(frame());
  assert.equal(text, Math.hypot(0.1, 0.3, 2.5).toFixed(2));
  assert.match(title, /2\.50 mm inferior, 0\.30 mm anterior, 0\.10 mm left\. It is not the error of a seed/);
});

test('a needle that is drawn back keeps the error of its deepest point, and says so', () => {
  const back = frame({ depth: 60 });
  assert.equal(isDrawnBack(frame({ depth: 65.95 })), false, 'a tremor');
  assert.equal(isDrawnBack(back), true);
  assert.equal(tipErrorText(back).text, tipErrorText(frame()).text);
  assert.match(tipErrorText(back).title, /deepest point, at a depth of 66\.0 mm/);
});

test('the ends are where a rigid needle would be, and off it by the error', () => {
  const ends = makeEnds();
  assert.equal(tipErrorEnds(frame(), 200, ends), true);
  assert.deepEqual(ends, { planned: f32(10, 5, 20), reached: f32(10.1, 4.7, 17.5) });
});

test('a base that is turned looks elsewhere', () => {
  const ends = makeEnds();
  // A quarter of a turn about +y turns the needle from +z to the patient's left.
  assert.ok(tipErrorEnds({ ...frame(), orientation: f32(Math.SQRT1_2, 0, Math.SQRT1_2, 0) }, 200, ends));
  ends.planned.forEach((value, k) => assert.ok(Math.abs(value - [210, 5, -180][k]) < 1e-3, `${ends.planned}`));
});

test('nothing is marked where there is no error, a small one, or a needle on its way out', () => {
  for (const unmarked of [frame({ error: NONE, of: NaN }), frame({ error: f32(0.2, 0.2, -0.3) }), frame({ depth: 50 })]) {
    assert.equal(tipErrorEnds(unmarked, 200, makeEnds()), false);
  }
});
