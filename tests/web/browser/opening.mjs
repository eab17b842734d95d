// SPDX-License-Identifier: GPL-3.0-or-later
// How long it is from the command to a needle in one's hand, in a browser that is open already:
//   node tests/web/browser/opening.mjs [STARTS] [SCENARIO]
// Each start has an empty cache of models; the demo's comes with the build.
import path from 'node:path';
import { openBrowser, openVisitor, waitUntilReady } from './browser.mjs';
import { DEMO, makeFolder, startServer } from './server.mjs';

const starts = Number(process.argv[2] ?? 5);
const scenario = path.resolve(process.argv[3] ?? DEMO);
const browser = await openBrowser();
const rows = [];
for (let k = 0; k < starts; k++) {
  const { folder, remove } = makeFolder();
  const begun = performance.now();
  const seconds = () => (performance.now() - begun) / 1000;
  const server = await startServer(folder, { scenario });
  const row = { listens: seconds() };
  const { page } = await openVisitor(browser, server.url);
  row.page = seconds();
  await waitUntilReady(page);
  row.needle = seconds();
  rows.push(row);
  console.log(`listens ${row.listens.toFixed(2)} s, page ${row.page.toFixed(2)} s, needle ready ${row.needle.toFixed(2)} s`);
  await page.close();
  await server.kill();
  remove();
}
const sorted = rows.map((row) => row.needle).sort((a, b) => a - b);
console.log(`needle ready: median ${sorted[Math.floor(starts / 2)].toFixed(2)} s, longest ${sorted[starts - 1].toFixed(2)} s of ${starts} starts`);
await browser.close();
