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
  send(data) {
    this.sent.push(new DataView(data).getUint32(0, true));
  }
};
const [HAND, COMMAND] = [16, 17];

test('a connection that cannot take more loses a hand on its way, but no command and not that the hand let go', () => {
  const session = new Session(new Connection('ws://localhost/live'));
  session.start();
  session.connected = true;
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
