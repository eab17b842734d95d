// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { colorsOf, FAR_MM, isKnown, MEASURES, scaleEnd, shortText, tellOf } from 'shared/hole_map';

const [bone, , rectum, , , tip] = MEASURES;
const hole = (name, toBone, tipError) => ({
  hole: name, depth_mm: 70, in_target_mm: 30, clearance_mm: { bone: toBone, urethra: 3, rectum: null },
  shift_at_break_mm: null, shift_max_mm: null, tip_error_mm: tipError === null ? null : { LR: 0, AP: 0, SI: -tipError, norm: tipError },
  predicted: tipError !== null, remark: '',
});
const map = { columns: ['A', 'B'], rows: ['1'], pitch_mm: 5, planned: 'A1', missing: 0, holes: [hole('A1', 0, 11.3), hole('B1', 31, null)] };

const luminance = ({ fill }) => {
  const [r, g, b] = fill.match(/\d+/g).map((v) => ((v / 255) ** 2.2));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};

test('dark is what to beware of: little clearance, much error', () => {
  const light = (measure, end, mm) => luminance(colorsOf(measure, end, mm));
  assert.ok(light(bone, FAR_MM, 0) < light(bone, FAR_MM, 5) && light(bone, FAR_MM, 5) < light(bone, FAR_MM, 20));
  assert.ok(light(tip, 15, 0) > light(tip, 15, 7) && light(tip, 15, 7) > light(tip, 15, 15));
  assert.deepEqual(colorsOf(bone, FAR_MM, 40), colorsOf(bone, FAR_MM, FAR_MM), 'far is far');
});

test('text can be read on every colour', () => {
  for (let mm = 0; mm <= FAR_MM; mm += 0.5) {
    const colors = colorsOf(bone, FAR_MM, mm);
    const [a, b] = [luminance(colors), colors.text === '#fff' ? 1 : 0.02].sort((x, y) => y - x);
    assert.ok((a + 0.05) / (b + 0.05) > 3, `${mm} mm: contrast ${((a + 0.05) / (b + 0.05)).toFixed(1)}`);
  }
});

test('scales end at round numbers, and what is missing is known to be', () => {
  assert.equal(scaleEnd(bone, map), FAR_MM);
  assert.equal(scaleEnd(tip, map), 15);
  assert.ok(isKnown(bone, map) && isKnown(tip, map) && !isKnown(rectum, map));
});

test('numbers and words of a hole', () => {
  assert.deepEqual([0, 0.04, 3.14, 9.96, 31].map(shortText), ['0', '0.0', '3.1', '10', '31']);
  assert.match(tellOf(map.holes[0]), /^Hole A1\n70.0 mm deep, 30.0 mm of it in the gland\nClearance to bone: passes through\nClearance to the urethra: 3.0 mm\nTip off its target: 11.30 mm$/);
  assert.doesNotMatch(tellOf(map.holes[1]), /Tip off|rectum/);
});
