// SPDX-License-Identifier: GPL-3.0-or-later
// Seeking repeats the command until the server shows the wanted time.
import assert from 'node:assert/strict';
import { beforeEach, mock, test } from 'node:test';
import { Seek } from 'live/src/controls/seek.ts';

globalThis.window = globalThis;

/** A replay that loses some of the commands. */
class Replay {
  connected = true;
  status = { state: 'ready', mode: 'replay', held: true, you_hold: true, replay: { name: 'one', time_s: 0, duration_s: 10, playing: false, rate: 0 } };
  asked = [];
  deaf = 0;         // number of next commands that are lost
  listeners = {};
  on(topic, listener) {
    (this.listeners[topic] ??= []).push(listener);
  }
  command({ time_s }) {
    this.asked.push(time_s);
    if (this.deaf-- <= 0) this.status.replay.time_s = Math.min(time_s, this.status.replay.duration_s);
  }
  tell(topic, what) {
    for (const listener of this.listeners[topic]) listener(what);
  }
  /** Lets time pass, with a frame every 16 ms. */
  pass(ms) {
    for (let t = 0; t < ms; t++) {
      mock.timers.tick(1);
      const { replay } = this.status;
      if (replay.playing) replay.time_s += replay.rate / 1000;
      if (t % 16 === 15) this.tell('frame', { replayed: true, time: replay.time_s });
    }
  }
}

const { tick } = mock.timers;
let replay, seek, now;
beforeEach(() => {
  mock.timers.reset();
  mock.timers.enable({ apis: ['setTimeout'] });
  now = 0;
  performance.now = () => now;
  mock.timers.tick = (ms) => {
    now += ms;
    tick.call(mock.timers, ms);
  };
  replay = new Replay();
  seek = new Seek(replay);
});

test('one that is heard is asked for once', () => {
  seek.to(3);
  assert.ok(seek.pending);
  replay.pass(1000);
  assert.deepEqual(replay.asked, [3]);
  assert.ok(!seek.pending);
});

test('one that comes to nothing is asked for again', () => {
  replay.deaf = 3;
  seek.to(3);
  replay.pass(2000);
  assert.deepEqual(replay.asked, [3, 3, 3, 3]);
  assert.equal(replay.status.replay.time_s, 3);
  assert.ok(!seek.pending);
});

test('of many in a short time the last one is what is shown', () => {
  for (let k = 1; k <= 100; k++) {
    seek.to(0.05 * k);
    replay.pass(3);
  }
  replay.pass(200);
  assert.equal(replay.status.replay.time_s, 5);
  assert.ok(replay.asked.length < 10, `${replay.asked}`);
  assert.ok(!seek.pending);
});

test('beyond the end the end is shown', () => {
  seek.to(12);
  replay.pass(100);
  assert.ok(!seek.pending);
});

test('a replay that plays goes on from there', () => {
  Object.assign(replay.status.replay, { time_s: 1, playing: true, rate: 4 });
  seek.to(5);
  replay.pass(1000);
  assert.deepEqual(replay.asked, [5]);
  assert.ok(replay.status.replay.time_s > 8.9);
});

test('a lost connection keeps what is wanted, another recording and another hand do not', () => {
  replay.connected = false;
  seek.to(3);
  replay.pass(500);
  assert.deepEqual(replay.asked, []);
  replay.connected = true;
  replay.pass(2000);
  assert.deepEqual(replay.asked, [3]);
  for (const change of [{ mode: 'live', replay: null }, { you_hold: false }, { replay: { ...replay.status.replay, name: 'two' } }]) {
    replay.deaf = Infinity;
    seek.to(4);
    assert.ok(seek.pending);
    replay.tell('status', { ...replay.status, ...change });
    assert.ok(!seek.pending);
  }
});
