// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the live page on three screens, before and after a push to the planned depth of the demo, with the gland's shift
// predicted for every hole of the template (which takes some minutes the first time):
//   node tests/web/browser/look.mjs build/web 'http://localhost:8000/?fake' out/look
// Ends with 1 if a script of the page complained.
import { mkdirSync } from 'node:fs';
import path from 'node:path';
import { openPage, readout, turnWheel, until, untilReadout, waitUntilReady } from './browser.mjs';

const [web, address, out] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
let complaints = 0;

/** Colours the template by the largest shift of the gland, once it is predicted for all holes. */
async function predictShift(page) {
  const choice = page.getByLabel('What the colours of the holes mean');
  if (!(await choice.isVisible())) return;
  const ask = page.getByRole('button', { name: 'Predict shift' });
  if (await ask.isVisible()) await ask.click();
  await until('predictions', () => page.locator('.map-row button').isVisible(), (unfinished) => !unfinished, 1_800_000);
  await choice.selectOption('shift');
}

for (const [width, height] of [[1366, 768], [1920, 1080], [3840, 2160]]) {
  const { page, problems, close } = await openPage(web, address, { width, height });
  await waitUntilReady(page);
  await page.waitForTimeout(1500);
  await page.screenshot({ path: path.join(out, `${width}-start.png`) });
  await predictShift(page);
  await page.getByRole('button', { name: 'Start again' }).click();  // a curve that begins with the push
  await page.waitForTimeout(1000);  // a needle that stood before the skin already shows so at once
  await untilReadout(page, 'Depth', (depth) => depth < 0);
  await turnWheel(page, 77);
  await page.waitForTimeout(6000);
  await page.screenshot({ path: path.join(out, `${width}-pushed.png`) });
  console.log(`${width} x ${height}: depth ${await readout(page, 'Depth')} mm, ${problems.length} complaints`);
  for (const problem of problems) console.log(`  ${problem}`);
  complaints += problems.length;
  await close();
}
process.exit(complaints > 0 ? 1 : 0);
