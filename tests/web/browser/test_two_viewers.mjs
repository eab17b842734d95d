// SPDX-License-Identifier: GPL-3.0-or-later
// Two viewers of one patient: one holds the needle; the other watches, asks for the needle and gets it.
import assert from 'node:assert/strict';
import {
  keepPicture, listenToEvents, openVisitor, readout, turnWheel, until, untilReadout, waitUntilReady,
} from './browser.mjs';
import { stage } from './stage.mjs';

let first, second;
const set = stage({
  async ready({ page, problems, browser, server }) {
    first = { page, problems };
    await waitUntilReady(first.page);
    await first.page.getByText('You hold the needle').waitFor();
    second = await openVisitor(browser, server.url);
    await waitUntilReady(second.page);
  },
});
const { test } = set;

test('the second watches', async () => {
  await second.page.getByText('You are watching, 1 other viewer').waitFor();
  await first.page.getByText('You hold the needle, 1 other viewer').waitFor();
  const heard = await listenToEvents(second.page);
  await turnWheel(first.page, 15);
  await untilReadout(first.page, 'Depth', (depth) => depth === 12);
  await untilReadout(second.page, 'Depth', (depth) => depth === 12);
  await until('the same force', async () => (await readout(second.page, 'Axial')) - (await readout(first.page, 'Axial')), (difference) => difference === 0);
  assert.ok((await heard()).some((text) => text.startsWith('Touched the skin')));
});

test('who watches cannot push', async () => {
  assert.ok(await second.page.getByRole('button', { name: 'Push' }).isDisabled());
  await turnWheel(second.page, 10);
  await second.page.getByLabel('Hole D4', { exact: true }).click();
  await second.page.getByText('You do not hold the needle.').waitFor();
  assert.equal(await readout(second.page, 'Depth'), 12);
  await keepPicture(second.page, 'watching');
});

test('the second asks, the first hands over', async () => {
  await second.page.getByRole('button', { name: 'Ask for the needle' }).click();
  await second.page.getByText('You have asked for the needle').waitFor();
  await first.page.getByText('Another viewer asks for the needle').waitFor();
  await keepPicture(first.page, 'asked');
  await first.page.getByRole('button', { name: 'Hand over' }).click();
  await second.page.getByText('You hold the needle').waitFor();
  await first.page.getByText('You are watching').waitFor();
  await turnWheel(second.page, 5);
  await untilReadout(first.page, 'Depth', (depth) => depth === 17);
});

test('who comes in the middle gets the whole curve and what has happened', async () => {
  const third = await openVisitor(set.browser, set.server.url);
  await waitUntilReady(third.page);
  await untilReadout(third.page, 'Depth', (depth) => depth === 17);
  assert.deepEqual(third.problems, []);
  await third.page.close();
});

test('when the holder closes the page the needle is free, and the other page takes it', async () => {
  await second.page.close();
  await until('the needle to be offered', () => first.page.locator('.holder').textContent(), (text) => /Nobody holds|You hold/.test(text));
  const take = first.page.getByRole('button', { name: 'Take the needle' });
  if (await take.isVisible()) await take.click();
  await first.page.getByText('You hold the needle').waitFor();
  assert.deepEqual([...first.problems, ...second.problems], []);
});
