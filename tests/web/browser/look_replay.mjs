// SPDX-License-Identifier: GPL-3.0-or-later
// Saves a picture of the last moment of a recording: the gland from the front with a wire frame of its initial
// position, and the sections. build/bin/stylet serve out/before/run.h5 node tests/web/browser/look_replay.mjs build/web
// "ADDRESS" out/before.png Ends with status 1 if a script of the page reported an error.
import { openPage, readout, until, waitUntilReady } from './browser.mjs';

// regions in front of the gland
const HIDDEN = ['Pubic arch', 'Band', 'Rectum', 'Rectal lumen', 'Levator', 'Periprostatic fat', 'Ischiorectal fat'];

const [web, address, file] = process.argv.slice(2);
const { page, problems, close } = await openPage(web, address, { width: 1366, height: 768 });
await waitUntilReady(page);
const replay = page.locator('#replay');
await replay.waitFor();
if (await replay.getByRole('button', { name: 'Pause' }).count()) await replay.getByRole('button', { name: 'Pause' }).click();
await page.getByRole('button', { name: 'Front' }).click();
await page.getByText('View', { exact: true }).click();
for (const label of HIDDEN) {
  const box = page.locator('.region label').filter({ hasText: new RegExp(`^${label}$`) }).locator('input');
  if (await box.count()) await box.uncheck();
}
await page.getByLabel('Gland before the insertion').check();
await page.getByText('View', { exact: true }).click();
for (let k = 0; k < 4; k++) await page.getByLabel('Closer').click();
const slider = page.getByLabel('Time of the recording');
await slider.evaluate((input) => {
  input.value = input.max;
  input.dispatchEvent(new Event('input'));
  input.dispatchEvent(new Event('change'));
});
const last = Number(await slider.getAttribute('max')).toFixed(2);
await until('the last moment', () => replay.locator('output').textContent(), (text) => text.startsWith(`${last} of`));
await page.waitForTimeout(3000);
await page.screenshot({ path: file, clip: { x: 0, y: 36, width: 1366, height: 500 } });
console.log(`${last} s: depth ${await readout(page, 'Depth')} mm, ${problems.length} complaints`);
await close();
process.exit(problems.length > 0 ? 1 : 0);
