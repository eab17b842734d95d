// SPDX-License-Identifier: GPL-3.0-or-later
// A figure that nobody knows is a dash, with the reason in its title, and never a zero.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { glandTexts, peakText, seedText, tipErrorText } from 'live/src/controls/key_figures.ts';
import { computerFacts } from 'live/src/controls/computer_details.ts';

test('shift and turn of the gland are unknown until a displacement has arrived', () => {
  const { shift, turn } = glandTexts(null, { stage: 'motion of the tissue' });
  for (const { text, title } of [shift, turn]) {
    assert.equal(text, '–');
    assert.equal(title, 'Not known: the motion of the tissue is still being prepared (motion of the tissue)');
  }
  assert.match(glandTexts(null, null).shift.title, /prepared$/);
  const known = glandTexts({ shift: [0, 0, 0], rotation: [0, 0, 0] }, null);
  assert.deepEqual([known.shift.text, known.turn.text], ['0.00', '0.0'], 'a gland that rests has not moved');
});

test('nothing is known before the first picture, and a recording does not have the tip', () => {
  assert.deepEqual(peakText(0, null), { text: '–', title: 'Not known: no picture of the needle has arrived yet' });
  assert.equal(tipErrorText(null).text, '–');
  const replayed = tipErrorText({ replayed: true, tipError: [NaN, NaN, NaN] });
  assert.deepEqual(replayed, { text: '–', title: 'Not known: a recording does not say which tissue the tip is in' });
});

test('a seed that is dropped here has a figure of its own, unknown with the reason', () => {
  const inside = { replayed: false, tipError: [0, 0, -21.8] };
  assert.equal(seedText(inside, { seed_off_mm: 1.44 }).text, '1.4');
  assert.equal(seedText(inside, { seed_off_mm: null }).title, 'Not known: the motion of the tissue in front of the tip has not been found');
  assert.equal(seedText({ replayed: false, tipError: [NaN, NaN, NaN] }, { seed_off_mm: 1 }).title, 'Not known: the tip is not in the tissue');
  assert.equal(seedText({ replayed: true }, { seed_off_mm: 1 }).text, '–');
  assert.equal(seedText(null, null).text, '–');
});

test('the work of the computer is said in sentences', () => {
  const loop = { steps: 14151, missed: 29, p50_us: 43.2, p99_us: 86, max_us: 231, rights: 'no special rights' };
  assert.deepEqual(computerFacts(null, { loop }), [
    '29 of 14,151 steps were late.', 'A step takes 43 µs; 99 % take at most 86 µs, the slowest took 231 µs.', 'It runs with no special rights.']);
  assert.deepEqual(computerFacts(null, null), ['No step has been computed yet.']);
  assert.deepEqual(computerFacts({ replayed: true }, { loop }), ['A recording is shown; nothing is computed.']);
});
