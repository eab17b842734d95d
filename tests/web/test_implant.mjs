// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { depthToGo, isFinished, meanMotion, nextNeedle, nextSeed, placesNow, replayWords, tallyRows, whatToDo } from 'live/src/implant/implant';
import { isodoseRings } from 'live/src/implant/isodose';
import { resultWords } from 'live/src/controls/dialogs';
import { offerWords } from 'live/src/implant/interrupted';
import { goalWords } from 'live/src/implant/end_card';
import { decode, Kind, WireError } from 'live/src/wire';

const needle = (name, ...depths) => ({
  name, hole: name, entry_mm: [0, 0, 0], direction: [0, 0, 1], depth_mm: 60, ready: true,
  seeds: depths.map((drop_depth_mm, k) => ({ number: 10 * name.charCodeAt(0) + k, planned_mm: [0, 0, drop_depth_mm], axis: [0, 0, 1], drop_depth_mm })),
});
const plan = (current) => ({ needles: [needle('A', 50, 40), needle('B', 55)], current, seed_length_mm: 4.5, seed_diameter_mm: 0.8, prescription_Gy: 145, source: '', technique: 'pushed' });
const implant = (...needles) => ({
  planned_seeds: 3, seeds: needles.map((n, i) => ({ needle: n, number: i, rest_mm: [0, 0, 10 * i], planned_mm: [0, 0, 0] })), computing: false, now: null, planned: null, error: null, why: [],
});

test('the next seed is the one behind those that were dropped', () => {
  assert.equal(nextSeed(plan(0), null).drop_depth_mm, 50);
  assert.equal(nextSeed(plan(0), implant(0)).drop_depth_mm, 40);
  assert.equal(nextSeed(plan(0), implant(0, 0)), null);
  assert.equal(nextSeed(plan(-1), implant()), null);
});

test('what to do is said in words', () => {
  assert.deepEqual(whatToDo(plan(0), null, 20), { text: 'Needle A, seed 1 of 2: push in 30.0 mm', inPlace: false });
  assert.deepEqual(whatToDo(plan(0), implant(0), 43), { text: 'Needle A, seed 2 of 2: pull back 3.0 mm', inPlace: false });
  assert.ok(whatToDo(plan(0), implant(0), 40.3).inPlace);
  assert.match(whatToDo(plan(0), implant(0, 0), 40).text, /Needle A is empty/);
  assert.match(whatToDo(plan(-1), implant(), 40).text, /not in the plan/);
  assert.match(whatToDo(plan(1), implant(0, 0, 1), 40).text, /All seeds/);
});

test('a preloaded needle is drawn back over its train', () => {
  const train = (current) => ({ ...plan(current), technique: 'preloaded' });
  assert.deepEqual(whatToDo(train(0), null, 20), { text: 'Needle A, train of 2 seeds: push in 40.0 mm', inPlace: false });
  assert.ok(whatToDo(train(0), null, 60.2).inPlace);
  assert.equal(depthToGo(train(0), null), 60);
  assert.equal(depthToGo(plan(0), null), 50, 'pushed seed by seed');
  const left = { ...implant(0), train_from_mm: 61 };  // begun one millimetre too deep
  assert.equal(whatToDo(train(0), left, 43).text, 'Needle A: draw back. Seed 2 of 2 is left in 2.0 mm');
  assert.equal(depthToGo(train(0), left), 39);
  assert.equal(depthToGo(train(0), implant(0, 0)), null);
});

test('a lost seed is nowhere', () => {
  const now = { now_mm: [[0, 0, 1], [0, 0, 13]] };
  const lost = implant(0, 0);
  lost.seeds[0].lost = true;
  assert.deepEqual(placesNow(lost, now), [null, [0, 0, 13]]);
  assert.deepEqual(meanMotion(lost, now), [0, 0, 3]);
});

test('a recording says what its needle had dropped', () => {
  assert.match(replayWords(plan(0), implant(0, 1)), /^Recording\. Needle A, 1 of 2 seeds dropped\./);
  assert.match(replayWords(plan(-1), null), /beside the plan/);
});

test('an interrupted implant is offered in plain words', () => {
  const at = (...date) => new Date(...date).getTime() / 1000;
  const offer = { recording: 'r', recorded_s: at(2026, 10, 29, 17, 5), seeds: 13, planned_seeds: 84, needle: 'B4' };
  const { question, meaning } = offerWords(offer, new Date(2026, 11, 1));
  assert.equal(question, 'Go on with the implant of 13 of 84 seeds from 29 November, 17:05?');
  assert.match(meaning, /needle B4 stands in front of the skin/);
  assert.match(offerWords(offer, new Date(2027, 0, 1)).question, /from 29 November 2026, 17:05\?/);
});

test('what the needles have done is counted in words', () => {
  const rows = (tally) => tallyRows({ skin_punctures: 0, organ_entries: 0, bone_contacts: 0, exits: 0, ...tally });
  assert.deepEqual(rows({ skin_punctures: 9 })[0], { what: 'Skin broken', often: '9 times', harm: false });
  assert.deepEqual(rows({ bone_contacts: 1 })[2], { what: 'Bone met', often: 'once', harm: true });
  assert.equal(rows({}).length, 3);
  assert.equal(rows({ exits: 2 })[3].often, 'twice');
});

test('a recording has its result, and only one that was cut off is interrupted', () => {
  const seeds = { dropped: 13, planned: 84, d90_percent: 21.34 };
  assert.equal(resultWords({ name: 'a', seeds, ended: true }), '13 of 84 seeds, D90 21.3 %');
  assert.equal(resultWords({ name: 'a', seeds: { ...seeds, d90_percent: null }, ended: false }), '13 of 84 seeds, interrupted');
  assert.equal(resultWords({ name: 'a', seeds: null, peak_force_N: 7.25, ended: false }, 'a'), 'at most 7.3 N, being recorded');
  assert.equal(resultWords({ name: 'a', problem: 'damaged' }), 'It cannot be read: damaged');
});

test('the next needle is the next one that has seeds', () => {
  assert.equal(nextNeedle(plan(0), implant(0)), 1);
  assert.equal(nextNeedle(plan(1), implant(1)), 0);
  assert.equal(nextNeedle(plan(0), implant(0, 0, 1)), -1);
  assert.ok(isFinished(implant(0, 0, 1)) && !isFinished(implant(0, 0)) && !isFinished(implant()));
});

test('seeds move with the tissue, and a seed that was just dropped is where it rests until its place is told', () => {
  const seeds = { now_mm: [[1, 0, 2]] };
  assert.deepEqual(meanMotion(implant(0), seeds), [1, 0, 2]);
  assert.deepEqual(meanMotion(implant(), null), [0, 0, 0]);
  assert.deepEqual(placesNow(implant(0, 0), seeds), [[1, 0, 2], [0, 0, 10]]);
});

/** A dose that falls linearly with the distance from the origin: 200 % there, 0 at 20 mm. */
function cone() {
  const size = [41, 41, 41];
  const values = new Uint16Array(41 ** 3);
  for (let k = 0, at = 0; k < 41; k++) for (let j = 0; j < 41; j++) for (let i = 0; i < 41; i++) values[at++] = Math.max(0, 10 * (200 - 10 * Math.hypot(i - 20, j - 20, k - 20)));
  return { size, origin: [-20, -20, -20], spacing: 1, unit: 0.1, values };
}

test('an isodose line is where the dose has its level, and moves with the seeds', () => {
  for (const axis of [0, 2]) {
    for (const [value, motion] of [[0, [0, 0, 0]], [6, [0, 0, 0]], [2.5, [0.4, -1, 3]]]) {
      const rings = isodoseRings(cone(), axis, value, 100, motion);
      assert.equal(rings.length, 1);
      const others = [0, 1, 2].filter((k) => k !== axis);
      for (const [a, b] of rings[0]) {
        const radius = Math.hypot(a - motion[others[0]], b - motion[others[1]], value - motion[axis]);
        assert.ok(Math.abs(radius - 10) < 0.3, `${radius} mm from the middle instead of 10`);
      }
    }
  }
  assert.deepEqual(isodoseRings(cone(), 2, 25, 100, [0, 0, 0]), [], 'outside of the grid');
  assert.deepEqual(isodoseRings(cone(), 2, 0, 300, [0, 0, 0]).filter((ring) => ring.length > 0), []);
});

test('goals are said as planners write them', () => {
  assert.equal(goalWords({ structure: 'prostate', metric: 'D90_percent', at_least: true, bound: 100 }), 'Prostate D90 ≥ 100 %');
  assert.equal(goalWords({ structure: 'rectum', metric: 'D0.1cc_Gy', at_least: false, bound: 200 }), 'Rectum D0.1cc ≤ 200 Gy');
});

test('a dose of the wrong length is refused', () => {
  const message = (points, extra) => {
    const buffer = new ArrayBuffer(40 + 2 * points + extra);
    const view = new DataView(buffer);
    view.setUint32(0, Kind.dose ?? 10, true);
    [points, 1, 1].forEach((n, i) => view.setUint32(8 + 4 * i, n, true));
    [1, 2, 3, 1.5, 0.1].forEach((x, i) => view.setFloat32(20 + 4 * i, x, true));
    return buffer;
  };
  const { dose } = decode(message(3, 0));
  assert.deepEqual([dose.size, dose.origin, dose.spacing, dose.values.length], [[3, 1, 1], [1, 2, 3], 1.5, 3]);
  assert.throws(() => decode(message(3, 2)), WireError);
});
