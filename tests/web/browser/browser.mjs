// SPDX-License-Identifier: GPL-3.0-or-later
// Opens a page in the Chromium of the machine, drawing in software, and says what a user would see.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

const PLACES = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];

/** Path of a Chromium, or null. */
export function findChromium() {
  return [process.env.CHROMIUM, ...PLACES].find((p) => p && existsSync(p)) ?? null;
}

/**
 * @param web folder whose node_modules has playwright-core: web/ of a build
 * @returns page, problems (what the page's scripts complained of), close()
 */
export async function openPage(web, address, { width = 1366, height = 768 } = {}) {
  const executablePath = findChromium();
  if (!executablePath) throw new Error('No Chromium was found: install the package chromium, or set CHROMIUM to its path.');
  const { chromium } = createRequire(path.join(path.resolve(web), 'package.json'))('playwright-core');
  const browser = await chromium.launch({
    executablePath,
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  const page = await browser.newPage({ viewport: { width, height } });
  const problems = [];
  page.on('pageerror', (error) => problems.push(error.message));
  page.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
  await page.goto(address);
  return { page, problems, close: () => browser.close() };
}

/** Waits until there is a patient and nothing covers it. */
export async function waitUntilReady(page, timeout = 120_000) {
  await page.locator('#cover').waitFor({ state: 'hidden', timeout });
  await page.locator('.readouts b').first().filter({ hasText: /\d/ }).waitFor({ timeout });
}

/** Number of a read-out by its label: "Depth", "Axial", "Speed", … */
export async function readout(page, label) {
  const text = await page.locator('.readouts .value', { has: page.locator('.name', { hasText: new RegExp(`^${label}$`) }) }).locator('b').textContent();
  return Number(text.replace('−', '-'));
}

/** Names of the events, as marks of the chart have them, in the order in which they happened: what a reader of screens hears. */
export async function listenToEvents(page) {
  await page.evaluate(() => {
    window.heard = [];
    const spoken = document.querySelector('.spoken');
    new MutationObserver(() => window.heard.push(spoken.textContent)).observe(spoken, { childList: true, characterData: true, subtree: true });
  });
  return () => page.evaluate(() => window.heard);
}

/** Turns the wheel over the 3D view: positive notches push. */
export async function turnWheel(page, notches) {
  const box = await page.locator('#view3d').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  for (let i = 0; i < Math.abs(notches); i++) await page.mouse.wheel(0, notches > 0 ? -100 : 100);
}
