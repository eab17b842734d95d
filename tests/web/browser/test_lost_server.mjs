// SPDX-License-Identifier: GPL-3.0-or-later
// A server that is killed and started again: the page reports the lost connection and reconnects on its own.
import assert from 'node:assert/strict';
import { keepPicture, turnWheel, untilReadout, waitUntilReady } from './browser.mjs';
import { SMALL, startServer } from './server.mjs';
import { stage } from './stage.mjs';

let page, problems;
const OPTIONS = [...SMALL, '--keep-token'];  // so that the page may connect to the next server
const set = stage({ options: OPTIONS, ready: async () => ({ page, problems } = set) });
const { test } = set;

test('the page says that it has lost the server, and shows the last pictures as old ones', async () => {
  await waitUntilReady(page);
  await turnWheel(page, 15);
  await untilReadout(page, 'Depth', (depth) => depth === 12);
  await set.server.kill('SIGKILL');
  await page.getByText('Connection lost').waitFor();
  await page.getByText('check whether stylet serve is still running').waitFor();
  assert.match(await page.locator('body').getAttribute('class'), /is-old/);
  assert.ok(await page.getByRole('button', { name: 'Push' }).isDisabled());
  await keepPicture(page, 'lost');
});

test('it goes on when there is a server again', async () => {
  set.server = await startServer(set.folder, { options: OPTIONS, port: set.server.port });
  await waitUntilReady(page);
  await page.getByText('You hold the needle').waitFor();
  await untilReadout(page, 'Depth', (depth) => depth === -3);
  await turnWheel(page, 10);
  await untilReadout(page, 'Depth', (depth) => depth === 7);
  // Messages of the browser itself about a server that does not answer are no faults of the page.
  assert.deepEqual(problems.filter((text) => !/ERR_CONNECTION|WebSocket connection/.test(text)), []);
});
