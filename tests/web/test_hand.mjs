// SPDX-License-Identifier: GPL-3.0-or-later
// The targets that the page sends while the needle is pushed and when it is released; frames show the needle with a
// delay.
import assert from 'node:assert/strict';
import { beforeEach, mock, test } from 'node:test';
import { HandControl } from 'live/src/hand.ts';

globalThis.window = globalThis;
const LATE_MS = 120;

/** A needle that follows the targets as the server's needle does; the page sees it with a delay. */
class Needle {
  constructor(depth) {
    this.depth = depth;
    this.steering = true;
    this.guest = '';
    this.scene = { limits: { depth_mm: 100, behind_mm: 30, tilt_deg: 10 } };
    this.listeners = {};
    this.sent = [];
    this.way = [];     // depths, one per millisecond
    this.target = { depth, speed: 0 };
    this.frame = this.seen();
  }
  on(topic, listener) {
    (this.listeners[topic] ??= []).push(listener);
  }
  sendHand(hand) {
    this.sent.push(hand);
    this.target = hand;
  }
  notify() {}
  seen() {
    const depth = this.way[Math.max(0, this.way.length - LATE_MS)] ?? this.depth;
    return { depth, paused: false, hand: [0, 0, 0] };
  }
  /** Lets time pass, with a frame every 16 ms. @param each called at every repaint */
  pass(ms, each = () => {}) {
    for (let t = 0; t < ms; t++) {
      const way = this.target.depth - this.depth;
      this.depth += Math.sign(way) * Math.min(Math.abs(way), this.target.speed / 1000);
      this.way.push(this.depth);
      mock.timers.tick(1);
      if (t % 16 !== 0) continue;
      this.frame = this.seen();
      for (const listener of this.listeners.frame) listener(this.frame);
      each();
    }
  }
  get turnedBack() {
    return this.way.reduce((most, depth, i) => Math.max(most, i > 0 ? this.way[i - 1] - depth : 0), 0);
  }
}

const { tick } = mock.timers;
let needle, hand, now;
beforeEach(() => {
  mock.timers.reset();
  mock.timers.enable({ apis: ['setTimeout'] });
  now = 0;
  needle = new Needle(10);
  hand = new HandControl(needle);
  performance.now = () => now;
  mock.timers.tick = (ms) => {
    now += ms;
    tick.call(mock.timers, ms);
  };
  needle.pass(50);
});

test('let go of a push, the needle stands where it is', () => {
  for (const speed of [5, 20, 50]) {
    hand.setSpeed(speed);
    const start = needle.depth;
    needle.pass(400, () => hand.hold(1));
    const there = needle.depth;
    assert.ok(there > start + 0.25 * speed, 'it was pushed');
    hand.stop();
    needle.pass(1000);
    assert.equal(needle.depth, there);
  }
  assert.equal(needle.turnedBack, 0);
});

test('pushed again at once, it goes on and never back; pulled, it comes back', () => {
  for (let k = 0; k < 4; k++) {
    needle.pass(150, () => hand.hold(1));
    hand.stop();
    needle.pass(30);
  }
  assert.equal(needle.turnedBack, 0);
  const there = needle.depth;
  needle.pass(200, () => hand.hold(-1));
  assert.ok(needle.depth < there - 2);
});

test('a wheel turned before the needle has been seen to stand counts from where it stands', () => {
  needle.pass(400, () => hand.hold(1));
  hand.stop();
  const there = needle.depth;
  hand.push(1);
  hand.push(1);
  needle.pass(1000);
  assert.ok(Math.abs(needle.depth - there - 2) < 1e-9, `${needle.depth} after ${there}`);
  assert.equal(needle.turnedBack, 0);
});

test('turning the bevel after a push does not move the needle', () => {
  needle.pass(400, () => hand.hold(1));
  hand.stop();
  const there = needle.depth;
  hand.roll(15);
  needle.pass(500);
  hand.roll(15);
  needle.pass(500);
  assert.equal(needle.depth, there);
  assert.equal(needle.sent.at(-1).roll, 30);
});

test('a tap moves it a little, half a trigger half as fast', () => {
  hand.hold(1);
  hand.stop();
  needle.pass(300);
  assert.ok(needle.depth > 10.1 && needle.depth < 11, `${needle.depth}`);
  const there = needle.depth;
  needle.pass(500, () => hand.hold(0.5));
  hand.stop();
  needle.pass(300);
  assert.ok(Math.abs(needle.depth - there - 5) < 0.7, `${needle.depth - there} mm in half a second at 10 mm/s`);
});

test('a key that was down when the needle jumped does not make the next tap shorter', () => {
  needle.pass(400, () => hand.hold(1));
  hand.rest();
  needle.target = { depth: needle.depth, speed: 0 };
  needle.pass(300);
  const there = needle.depth;
  hand.hold(1);
  hand.stop();
  needle.pass(300);
  assert.ok(needle.depth > there + 0.1, `${needle.depth - there} mm`);
});

test('a needle that the server has stopped on its way is told of and stays, and a push starts from where it is', () => {
  const told = [];
  needle.notify = (text) => told.push(text);
  const stop = () => needle.listeners.stopped.forEach((listener) => listener());
  stop();
  assert.deepEqual(told, [], 'nothing moved');
  hand.setSpeed(20);
  hand.push(30);
  needle.pass(500);
  needle.target = { depth: needle.depth, speed: 0 };  // the server does so
  stop();
  assert.equal(told.length, 1);
  const there = needle.depth;
  needle.pass(500);
  assert.equal(needle.depth, there);
  hand.push(1);
  needle.pass(500);
  assert.ok(Math.abs(needle.depth - there - 1) < 0.05, `${needle.depth} after ${there}`);
});
