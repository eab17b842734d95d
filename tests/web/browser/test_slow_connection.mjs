// SPDX-License-Identifier: GPL-3.0-or-later
// A page behind a connection that stops for a while: it says how old its picture is, its needle stands, and it goes on.
import assert from 'node:assert/strict';
import { after } from 'node:test';
import { keepPicture, openVisitor, readout, turnWheel, until, untilReadout, waitUntilReady } from './browser.mjs';
import { startProxy } from './slow_proxy.mjs';
import { stage } from './stage.mjs';

const FAST = 1e8;  // [bytes/s]
let proxy, slow, watcher;
const set = stage({
  async ready({ page, browser, server }) {
    watcher = page;
    await waitUntilReady(watcher);
    proxy = await startProxy(server.port, FAST);
    const address = new URL(server.url);
    address.port = String(proxy.port);
    slow = await openVisitor(browser, address.href);
    await waitUntilReady(slow.page);
    await slow.page.getByRole('button', { name: 'Ask for the needle' }).click();
    await watcher.getByRole('button', { name: 'Hand over' }).click();
    await slow.page.getByText('You hold the needle').waitFor();
  },
});
const { test } = set;
after(() => proxy?.close());  // an open proxy keeps a failed run from ending
const age = () => slow.page.locator('.picture-age');

test('a page that gets nothing says how old its picture is', async () => {
  await age().waitFor({ state: 'hidden' });
  proxy.limit(0);
  await age().filter({ hasText: /The picture is [1-9]\d*\.\d s old: no newer one has come/ }).waitFor();
  for (const [width, height] of [[1366, 768], [390, 844]]) {
    await slow.page.setViewportSize({ width, height });
    const box = await age().boundingBox();
    assert.ok(box.x >= 0 && box.x + box.width <= width && box.y >= 0 && box.y + box.height <= height, `it is cut off at ${width} px`);
    await keepPicture(slow.page, `old-at-${width}`);
  }
  await slow.page.setViewportSize({ width: 1366, height: 768 });
  proxy.limit(FAST);
  await age().waitFor({ state: 'hidden' });
});

test('a page that does not answer while its needle is on its way has it stopped, and is told', async () => {
  await slow.page.keyboard.press('1');  // 5 mm/s: it would take 20 s
  await turnWheel(slow.page, 100);
  await until('the needle to move', () => readout(watcher, 'Depth'), (depth) => depth > -2);
  proxy.hold(true);
  let there;
  await until('the needle to stand', async () => {
    const before = await readout(watcher, 'Depth');
    await new Promise((resolve) => setTimeout(resolve, 500));
    there = await readout(watcher, 'Depth');
    return there - before;
  }, (way) => way === 0);
  assert.ok(there < 80, `it went on to ${there} mm`);
  proxy.hold(false);
  await slow.page.getByText('The needle was stopped where it is, because this page did not answer.').waitFor();
  assert.equal(await readout(watcher, 'Depth'), there);
  await turnWheel(slow.page, 2);
  await untilReadout(watcher, 'Depth', (depth) => Math.abs(depth - there - 2) < 0.11);
  assert.deepEqual(slow.problems, []);
});
