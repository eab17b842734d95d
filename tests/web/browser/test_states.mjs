// SPDX-License-Identifier: GPL-3.0-or-later
// Rare states: a case that cannot be loaded, a browser without 3D, a server that needs a token.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, afterEach, before, test } from 'node:test';
import { keepPicture, openBrowser, openVisitor, skipWithoutChromium, turnWheel, untilReadout, waitUntilReady } from './browser.mjs';
import { DEMO, makeFolder, SMALL, startServer } from './server.mjs';

skipWithoutChromium();
const { folder, remove } = makeFolder();
let server, browser, withoutGl;

before(async () => {
  browser = await openBrowser();
  withoutGl = await openBrowser({ webgl: false, pictures: false });
});
afterEach(() => server?.kill());
after(async () => {
  await browser?.close();
  await withoutGl?.close();
  remove();
});

test('a case that has never been open: the page says what it waits for', async () => {
  // loading takes much longer than this test
  server = await startServer(folder, { options: ['--set', 'mesh.nodes=30000'] });
  const { page, problems } = await openVisitor(browser, server.url);
  await page.getByText('Preparing the patient').waitFor();
  assert.equal(await page.locator('.recording').isVisible(), false, 'nothing is recorded yet');
  await page.locator('.card progress[value]').waitFor();
  await keepPicture(page, 'loading');
  assert.deepEqual(problems, []);
  await server.kill('SIGKILL');
  await page.close();
});

test('a case that cannot be read: what is wrong, where, and what to do', async () => {
  const scenario = path.join(folder, 'broken.toml');
  writeFileSync(scenario, '[patient]\nsource = "contours.dcm"\n[[insertion]]\nhole = "e3.5"\n');
  writeFileSync(path.join(folder, 'contours.dcm'), 'no contours');
  server = await startServer(folder, { scenario, options: SMALL });
  const { page, problems } = await openVisitor(browser, server.url);
  await page.getByText('This case could not be loaded').waitFor();
  const card = await page.locator('.card').innerText();
  assert.match(card, /contours\.dcm/);
  assert.ok((await page.locator('.card .cure').innerText()).length > 10, card);
  await keepPicture(page, 'failed');
  assert.deepEqual(problems, []);
  await page.close();
});

test('a second case that cannot be had leaves the first one there', async () => {
  const broken = path.join(folder, 'beside.toml');
  writeFileSync(broken, '[patient]\nsource = "phantom"\n[[insertion]]\nentry_mm = [400, 5, -60]\ndirection = [0, 0, 1]\n');
  server = await startServer(folder, { scenario: DEMO, options: [broken, ...SMALL] });
  const { page, problems } = await openVisitor(withoutGl, server.url);
  await waitUntilReady(page);
  await page.getByLabel('Case').selectOption({ index: 1 });
  await page.locator('.notice').filter({ hasText: 'misses the patient' }).waitFor();
  await waitUntilReady(page);
  assert.equal(await page.getByLabel('Case').evaluate((select) => select.selectedIndex), 0);
  await turnWheel(page, 10);
  await untilReadout(page, 'Depth', (depth) => depth === 7);
  assert.deepEqual(problems, []);
  await page.close();
});

test('a browser without 3D: sections, curve and hand work all the same', async () => {
  server = await startServer(folder, { options: SMALL });
  const { page, problems } = await openVisitor(withoutGl, server.url);
  await waitUntilReady(page);
  await page.getByText('This browser offers no WebGL').waitFor();
  await turnWheel(page, 20);
  await untilReadout(page, 'Depth', (depth) => depth === 17);
  assert.deepEqual(problems, []);
  await page.close();
});

test('without the token it says where the address is', async () => {
  server = await startServer(folder, { options: SMALL });
  const { page } = await openVisitor(withoutGl, `http://localhost:${server.port}/`);
  await page.getByText('open the address that stylet serve printed').waitFor();
  await page.goto(`http://localhost:${server.port}/${new URL(server.url).search}`);
  await waitUntilReady(page);
  await page.close();
});
