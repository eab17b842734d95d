// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { nameRegions, saysHarm, withWords } from 'live/src/event_names.ts';
import { speakEvents } from 'live/src/controls/notices.ts';

nameRegions([{ name: 'body', label: 'Body' }, { name: 'rectum', label: 'Rectum', spared: true }]);
const at = (kind, region, label) => ({ kind, region, label, depth_mm: 63.2, time_s: 1, force_N: 2 });
const capsule = [at('puncture', 'body', 'Left the prostate'), at('region_entered', 'body', '')];

test('a crossing is said once, in the words of the server', () => {
  assert.deepEqual(withWords(capsule).map((event) => event.label), ['Left the prostate']);
});

test('the words of a puncture into an organ to be spared say a harm', () => {
  assert.ok(saysHarm(at('puncture', 'rectum', 'Entered the rectum')));
  assert.ok(!saysHarm(at('puncture', 'body', 'Left the rectum')));
});

test('what is announced when the needle leaves the gland is not the skin', () => {
  const spoken = { setAttribute() {} };
  globalThis.document = { createElement: () => spoken };
  let happen;
  speakEvents({ append() {} }, { frame: { replayed: false }, on: (_, listener) => (happen = listener) });
  for (const event of capsule) happen(event);
  assert.equal(spoken.textContent, 'Left the prostate, 63 mm, 2.0 N');
});
