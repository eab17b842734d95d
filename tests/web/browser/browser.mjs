// SPDX-License-Identifier: GPL-3.0-or-later
// Opens a page in an installed Chromium with software rendering, and reads what a user would see.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const PLACES = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
const WEB = process.env.STYLET_WEB ?? path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../../../build/web');
const SKIPPED = 77;
// Only WebGL is rendered in software, as Chromium does without graphics hardware. The page itself does not need it.
const SOFTWARE_GL = ['--use-gl=angle', '--use-angle=swiftshader-webgl', '--enable-unsafe-swiftshader'];
// three.js reports this on the console
const NO_GL_SAID = /Error creating WebGL context|WebGL context could not be created/;
const NO_GL = ['--disable-gpu', '--disable-3d-apis'];
/** With software rendering on a busy machine there may be seconds between two pictures. */
export const PATIENCE_MS = 120_000;

/** The path of a Chromium, or null. */
export function findChromium() {
  return [process.env.CHROMIUM, ...PLACES].find((p) => p && existsSync(p)) ?? null;
}

/** Ends a test as skipped if there is no browser. */
export function skipWithoutChromium() {
  if (findChromium()) return;
  console.log('Skipped: no Chromium. Install the package chromium, or set CHROMIUM to its path.');
  process.exit(SKIPPED);
}

/**
 * @param web folder whose node_modules has playwright-core: web/ of a build
 * @param webgl false: without the 3D view, which takes most of the time with software rendering
 * @param pictures whether pictures are saved if a folder is given; then there is a 3D view in any case
 */
export async function openBrowser({ web = WEB, webgl = true, pictures = true, options = [] } = {}) {
  const executablePath = findChromium();
  if (!executablePath) throw new Error('No Chromium was found: install the package chromium, or set CHROMIUM to its path.');
  const { chromium } = createRequire(path.join(path.resolve(web), 'package.json'))('playwright-core');
  return chromium.launch({
    executablePath,
    args: ['--no-sandbox', ...(webgl || (pictures && process.env.STYLET_SCREENSHOTS) ? SOFTWARE_GL : NO_GL), ...options],
  });
}

/**
 * Opens a separate page, like another visitor.
 * @param prepare called with the page before it is opened
 * @returns page, and problems: the errors of the page's scripts
 */
export async function openVisitor(browser, address, { width = 1366, height = 768, prepare = async () => {} } = {}) {
  const page = await browser.newPage({ viewport: { width, height } });
  page.setDefaultTimeout(PATIENCE_MS);
  const problems = [];
  page.on('pageerror', (error) => problems.push(error.message));
  page.on('console', (message) => message.type() === 'error' && !NO_GL_SAID.test(message.text()) && problems.push(message.text()));
  await prepare(page);
  await page.goto(address);
  return { page, problems };
}

/** Starts a browser with one page. @returns page, problems, close() */
export async function openPage(web, address, size = {}) {
  const browser = await openBrowser({ web });
  return { ...(await openVisitor(browser, address, size)), close: () => browser.close() };
}

/** Waits until a patient is shown and nothing covers it. */
export async function waitUntilReady(page, timeout = PATIENCE_MS) {
  await page.locator('#cover').waitFor({ state: 'hidden', timeout });
  await page.locator('.readouts b').first().filter({ hasText: /\d/ }).waitFor({ timeout });
}

/** The value of a readout, by its label: "Depth", "Axial", "Speed", … */
export async function readout(page, label) {
  const text = await page.locator('.readouts .value', { has: page.locator('.name', { hasText: new RegExp(`^${label}$`) }) }).locator('b').textContent();
  return Number(text.replace('−', '-'));
}

/** The value of a key figure, by its name: "Peak force", "Tip off its target", …; NaN if there is none. */
export async function figure(page, name) {
  return Number(await page.locator('.figure').filter({ hasText: name }).locator('b').textContent());
}

/** Waits until the result of `ask` satisfies `good`, and returns it. Fails with the last result. */
export async function until(what, ask, good, timeout = PATIENCE_MS) {
  const end = Date.now() + timeout;
  let value;
  do {
    value = await ask();
    if (good(value)) return value;
    await new Promise((resolve) => setTimeout(resolve, 50));
  } while (Date.now() < end);
  assert.fail(`waited in vain for ${what}; last was ${JSON.stringify(value)}`);
}

/** Waits until the page has marked a moment of its opening ("needle ready", "3D view"). @returns it [ms since 1970] */
export function marked(page, name) {
  return until(name, () => page.evaluate((mark) => {
    const [entry] = performance.getEntriesByName(mark);
    return entry ? performance.timeOrigin + entry.startTime : 0;
  }, name), Boolean);
}

/** Waits until the value of a readout satisfies `good`, and returns it. */
export function untilReadout(page, label, good) {
  return until(`${label} ${good}`, () => readout(page, label), good);
}

/** The names of the events in their order, as they are announced to screen readers. */
export async function listenToEvents(page) {
  await page.evaluate(() => {
    window.heard = [];
    const spoken = document.querySelector('.spoken');
    new MutationObserver(() => window.heard.push(spoken.textContent)).observe(spoken, { childList: true, characterData: true, subtree: true });
  });
  return () => page.evaluate(() => window.heard);
}

/** Turns the wheel over the 3D view; positive notches push. */
export async function turnWheel(page, notches) {
  const box = await page.locator('#view3d').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  for (let left = Math.abs(notches); left > 0; left -= 5) await page.mouse.wheel(0, -100 * Math.sign(notches) * Math.min(left, 5));
}

/** Tests of which each continues from the end of the previous one. After a failure the others are skipped. */
export function inOrder() {
  let failed = false;
  return (name, action) => test(name, async (t) => {
    if (failed) return t.skip('the one before failed');
    try {
      await action(t);
    } catch (error) {
      failed = true;
      throw error;
    }
  });
}

/** Saves a picture of the page in the folder named by STYLET_SCREENSHOTS, if that is set. */
export async function keepPicture(page, name) {
  const folder = process.env.STYLET_SCREENSHOTS;
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: path.join(folder, `live-${name}.png`) });
}
