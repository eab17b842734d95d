// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ageInWords } from 'live/src/picture_age.ts';

const live = { connected: true, status: { state: 'ready', mode: 'live', lag_s: 0.02 }, frame: { paused: false }, frameAt: 1000, replaying: false };

test('says nothing of a picture that is new, as old as a sign of life may be', () => {
  assert.equal(ageInWords(live, 1000), '');
  assert.equal(ageInWords(live, 1200), '');
});

test('says how old it is on a slow connection, and where no newer one has come', () => {
  const slow = { ...live, status: { ...live.status, lag_s: 0.61 } };
  assert.equal(ageInWords(slow, 1200), 'The picture is 0.8 s old: the connection is slow.');
  assert.equal(ageInWords(live, 1390), 'The picture is 0.4 s old: the connection is slow.');
  assert.equal(ageInWords(live, 4000), 'The picture is 3.0 s old: no newer one has come.');
});

test('a picture does not age while nothing goes on', () => {
  const at = 9000;
  assert.equal(ageInWords({ ...live, frame: { paused: true } }, at), '');
  assert.equal(ageInWords({ ...live, frame: null }, at), '');
  assert.equal(ageInWords({ ...live, connected: false }, at), '');
  assert.equal(ageInWords({ ...live, status: { state: 'loading' } }, at), '');
  const replay = { ...live, replaying: true, status: { ...live.status, replay: { playing: false } } };
  assert.equal(ageInWords(replay, at), '');
  assert.notEqual(ageInWords({ ...replay, status: { ...live.status, replay: { playing: true } } }, at), '');
});
