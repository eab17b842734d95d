// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the live page on three screens, before and after a push:
//   node tests/web/browser/look.mjs build/web 'http://localhost:8000/?fake' out/look
// Ends with 1 if a script of the page complained.
import { mkdirSync } from 'node:fs';
import path from 'node:path';
import { openPage, readout, turnWheel, waitUntilReady } from './browser.mjs';

const [web, address, out] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
let complaints = 0;
for (const [width, height] of [[1366, 768], [1920, 1080], [3840, 2160]]) {
  const { page, problems, close } = await openPage(web, address, { width, height });
  await waitUntilReady(page);
  await page.waitForTimeout(1500);
  await page.screenshot({ path: path.join(out, `${width}-start.png`) });
  await turnWheel(page, 45);
  await page.waitForTimeout(6000);
  await page.screenshot({ path: path.join(out, `${width}-pushed.png`) });
  console.log(`${width} x ${height}: depth ${await readout(page, 'Depth')} mm, ${problems.length} complaints`);
  for (const problem of problems) console.log(`  ${problem}`);
  complaints += problems.length;
  await close();
}
process.exit(complaints > 0 ? 1 : 0);
