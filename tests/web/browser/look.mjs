// SPDX-License-Identifier: GPL-3.0-or-later
// Saves pictures of the live page on three screen sizes, before and after a push to the planned depth of the demo, with
// the predicted shift of the gland for every hole of the template (which takes some minutes the first time): node
// tests/web/browser/look.mjs build/web 'http://localhost:8000/?fake' out/look Ends with status 1 if a script of the
// page reported an error.
import { mkdirSync } from 'node:fs';
import path from 'node:path';
import { openPage, readout, turnWheel, until, untilReadout, waitUntilReady } from './browser.mjs';

const [web, address, out] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
let complaints = 0;

/** Waits for the predictions of all holes and colours the template by the largest shift of the gland. */
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
  await page.getByRole('button', { name: 'Start again' }).click();  // so that the curve starts with the push
  await page.waitForTimeout(1000);  // until the page shows the needle in front of the skin
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
