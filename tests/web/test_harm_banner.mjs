// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { harmNow, harmsSoFar } from 'live/src/controls/harm_banner.ts';
import { speakEvents } from 'live/src/controls/notices.ts';
import { harmSentence, isHarm, nameRegions } from 'live/src/event_names.ts';
import { TIP_STATES } from 'live/src/wire.ts';

const regions = [['body', 'Body'], ['prostate', 'Prostate'], ['rectum', 'Rectum', true], ['bladder', 'Bladder', true], ['pubic_arch', 'Pubic arch']]
  .map(([name, label, spared = false]) => ({ name, label, spared }));
nameRegions(regions);
const now = (inside, tip = 'cutting') => harmNow({ scene: { regions }, status: { inside }, frame: { tipState: TIP_STATES.indexOf(tip) } });

test('a needle in an organ that is to be spared is said in words, whichever part of it is there', () => {
  assert.equal(now([]), '');
  assert.equal(now(['prostate', 'body']), '');
  assert.equal(now(['rectum', 'body']), 'The needle’s tip is in the rectum');
  assert.equal(now(['prostate', 'rectum', 'body']), 'The needle’s shaft is in the rectum');
  assert.equal(now(['bladder', 'rectum', 'body']), 'The needle is in the bladder and the rectum');
});

test('bone and the far side are said as well, after what is worse', () => {
  assert.equal(now(['body'], 'on bone'), 'The needle’s tip is on bone');
  assert.equal(now(['body'], 'through'), 'The needle has come out of the body');
  assert.equal(now(['rectum', 'body'], 'on bone'), 'The needle’s tip is in the rectum');
  assert.equal(harmNow({ scene: null, status: null, frame: null }), '');
});

test('what stays is a sentence with the depth', () => {
  const event = (kind, region) => ({ kind, region, depth_mm: 63.2, time_s: 1, force_N: 1 });
  assert.ok(isHarm(event('region_entered', 'rectum')));
  assert.equal(harmSentence(event('region_entered', 'rectum')), 'Needle entered the rectum at 63 mm');
  assert.equal(harmSentence(event('bone_contact', 'pubic_arch')), 'Needle met bone (pubic arch) at 63 mm');
  assert.ok(isHarm(event('exited', 'body')));
  assert.ok(!isHarm(event('region_entered', 'prostate')) && !isHarm(event('puncture', 'rectum')));
});

test('the list of a replay ends at the moment that is shown', () => {
  const at = (time_s) => ({ kind: 'bone_contact', region: 'pubic_arch', depth_mm: 60, time_s, force_N: 1 });
  const events = [at(1), at(2), { ...at(2), kind: 'puncture' }, at(3)];
  const times = (frame) => harmsSoFar({ events, frame }).map((event) => event.time_s);
  assert.deepEqual(times({ replayed: true, time: 0 }), []);
  assert.deepEqual(times({ replayed: true, time: 2 }), [1, 2]);
  assert.deepEqual(times({ replayed: false, time: 0.5 }), [1, 2, 3]);
  assert.deepEqual(times(null), [], 'before the first picture nobody knows');
});

test('events are spoken as they happen, not those of a recording nor those that come with a scene', () => {
  globalThis.document = { createElement: () => ({ setAttribute() {} }) };
  const listeners = [];
  const session = { frame: null, on: (_, listener) => listeners.push(listener) };
  let spoken;
  speakEvents({ append: (element) => (spoken = element) }, session);
  const say = (frame) => {
    session.frame = frame;
    spoken.textContent = '';
    for (const listener of listeners) listener({ kind: 'skin_contact', region: 'body', label: 'Touched the skin', depth_mm: 0, time_s: 1, force_N: 0 });
    return spoken.textContent;
  };
  assert.equal(say(null), '');
  assert.equal(say({ replayed: true }), '');
  assert.match(say({ replayed: false }), /^Touched the skin/);
});
