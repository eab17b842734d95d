// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Connection } from 'live/src/connection.ts';
import { Session } from 'live/src/session.ts';

let socket;
globalThis.WebSocket = class {
  static OPEN = 1;
  readyState = 1;
  bufferedAmount = 0;
  sent = [];
  constructor() {
    socket = this;
  }
  addEventListener() {}
  numbers = [];
  send(data) {
    const view = new DataView(data);
    this.sent.push(view.getUint32(0, true));
    if (view.getUint32(0, true) === SEEN) this.numbers.push(view.getUint32(8, true));
  }
};
const [HAND, COMMAND, SEEN] = [16, 17, 18];
let here = () => {};
globalThis.setInterval = (turn) => (here = turn);

/** A message of the server without content that a page understands. */
function message(kind, number, text = '') {
  const data = new Uint8Array(8 + text.length);
  data.set(new TextEncoder().encode(text), 8);
  const view = new DataView(data.buffer);
  view.setUint32(0, kind, true);
  view.setUint32(4, number, true);
  return data.buffer;
}
const status = (number, more) => message(3, number, JSON.stringify({ state: 'ready', mode: 'live', held: true, ...more }));

function opened() {
  const session = new Session(new Connection('ws://localhost/live'));
  session.start();
  session.connected = true;
  return session;
}

test('a connection that cannot take more loses a hand on its way, but no command and not that the hand let go', () => {
  const session = opened();
  session.status = { state: 'ready', mode: 'live', you_hold: true };
  const hand = { depth: 10, speed: 20, roll: 0, tiltLeft: 0, tiltAnterior: 0 };
  session.sendHand(hand);
  assert.deepEqual(socket.sent, [HAND]);
  socket.bufferedAmount = 5000;
  session.sendHand(hand);
  assert.deepEqual(socket.sent, [HAND]);
  session.command({ do: 'seek', time_s: 1 });
  session.sendHand({ ...hand, speed: 0 });
  assert.deepEqual(socket.sent, [HAND, COMMAND, HAND]);
});

test('says what it has taken up, also of what it does not understand, and not of each event', () => {
  const session = opened();
  session.message(status(5));
  session.message(message(4, 6, '{"kind": "puncture"}'));
  session.message(message(2, 7));  // a frame without its header
  assert.deepEqual(socket.numbers, [5, 7]);
  session.on('image', () => {
    throw new Error('a part of the page fails');
  });
  const image = new Uint8Array(new ArrayBuffer(22));
  image.set(new Uint8Array(message(11, 8)));
  image[8] = 2;
  image.set([0x7b, 0x7d], 20);
  assert.throws(() => session.message(image.buffer));
  assert.deepEqual(socket.numbers, [5, 7, 8]);
});

test('while it holds the needle it says that it is there, and otherwise not', () => {
  const session = opened();
  session.message(status(5));
  here();
  assert.deepEqual(socket.numbers, [5]);
  session.message(status(6, { you_hold: true }));
  here();
  assert.deepEqual(socket.numbers, [5, 6, 6]);
});

test('told once that its hand was stopped, it goes on after its parts have been told', () => {
  const session = opened();
  const sentBefore = [];
  session.on('stopped', () => sentBefore.push(socket.sent.length));
  for (const number of [1, 2]) session.message(status(number, { you_hold: true, hand_stopped: true }));
  assert.deepEqual(sentBefore, [0]);
  assert.deepEqual(socket.sent, [COMMAND, SEEN, SEEN]);
  session.message(status(3, { you_hold: true, hand_stopped: false }));
  session.message(status(4, { you_hold: true, hand_stopped: true }));
  assert.equal(sentBefore.length, 2);
});
