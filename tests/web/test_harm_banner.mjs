// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { harmNow } from 'live/src/controls/harm_banner.ts';
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
