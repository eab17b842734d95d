// SPDX-License-Identifier: GPL-3.0-or-later
// A short session of the kind that long_session.mjs runs for a longer time. Uncollected garbage takes some tenths of a
// megabyte; if the frames of this time were kept, they would take tens of megabytes.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { skipWithoutChromium } from './browser.mjs';
import { longSession } from './long_session.mjs';

skipWithoutChromium();

test('page and server do not grow while the needle goes to and fro', async (t) => {
  const { grown, messagesPerSecond, problems } = await longSession(30);
  t.diagnostic(`grown: ${JSON.stringify(grown)}, ${messagesPerSecond.toFixed(0)} messages a second`);
  assert.ok(grown.heap < 2, `the page grew by ${grown.heap} MB`);
  assert.ok(grown.nodes < 100 && grown.listeners < 20, `the page grew by ${grown.nodes} nodes and ${grown.listeners} listeners`);
  assert.ok(grown.server < 10, `the server grew by ${grown.server} MB`);
  assert.deepEqual(problems, []);
});
