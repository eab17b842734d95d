// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the time from the command until the needle can be moved, and until the first picture of the 3D view:
//   node tests/web/browser/opening.mjs [STARTS] [SCENARIO] [open|started]
// in a browser with an open window, or in a browser that is started as soon as the server has printed its address. Each
// start has an empty cache of models; the model of the demo comes with the build.
import path from 'node:path';
import { marked, openBrowser, openVisitor } from './browser.mjs';
import { DEMO, makeFolder, startServer } from './server.mjs';

const starts = Number(process.argv[2] ?? 5);
const scenario = path.resolve(process.argv[3] ?? DEMO);
const way = process.argv[4] ?? 'open';
if (way !== 'open' && way !== 'started') throw new Error(`"${way}" is neither "open" nor "started"`);
const open = way === 'open';
const REST_MS = 1500;  // pause, so that work of the window and of the previous start does not disturb this one
let browser = open ? await openBrowser() : null;
const rows = [];
for (let k = 0; k < starts; k++) {
  const { folder, remove } = makeFolder();
  const window = open ? await openVisitor(browser, 'about:blank') : null;
  await new Promise((resolve) => setTimeout(resolve, REST_MS));
  const begun = performance.now();
  const seconds = () => (performance.now() - begun) / 1000;
  const server = await startServer(folder, { scenario });
  const row = { listens: seconds() };
  browser ??= await openBrowser();
  if (open) await window.page.goto(server.url);
  const { page } = window ?? (await openVisitor(browser, server.url));
  row.page = seconds();
  row.needle = ((await marked(page, 'needle ready')) - performance.timeOrigin - begun) / 1000;
  row.view = ((await marked(page, '3D view')) - performance.timeOrigin - begun) / 1000;
  rows.push(row);
  console.log(`listens ${row.listens.toFixed(2)} s, page ${row.page.toFixed(2)} s, needle ready ${row.needle.toFixed(2)} s, 3D view ${row.view.toFixed(2)} s`);
  await page.close();
  if (!open) {
    await browser.close();
    browser = null;
  }
  await server.kill();
  remove();
}
for (const [what, name] of [['needle', 'needle ready'], ['view', '3D view']]) {
  const sorted = rows.map((row) => row[what]).sort((a, b) => a - b);
  console.log(`${name}: median ${sorted[Math.floor(starts / 2)].toFixed(2)} s, longest ${sorted[starts - 1].toFixed(2)} s of ${starts} starts`);
}
await browser?.close();
