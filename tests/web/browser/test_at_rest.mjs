// SPDX-License-Identifier: GPL-3.0-or-later
// A page that is opened while nothing moves shows the displacement, with a colour scale that fits it.
import assert from 'node:assert/strict';
import { after, before } from 'node:test';
import { inOrder, marked, openBrowser, openVisitor, skipWithoutChromium, turnWheel, until, untilReadout, waitUntilReady } from './browser.mjs';
import { makeFolder, SMALL, startServer } from './server.mjs';

skipWithoutChromium();
const FRAME = 2;  // docs/live_protocol.md
const PAUSED = 1;
const SHORT_DISPLACEMENT = 32;
const SMALLEST_SCALE_MM = 0.5;
// At rest the needle displaces the demo's tissue by a few tenths of a millimetre, which fits the smallest scale.
const SOFT = ['--set', 'tissue.body.young_kPa=3', '--set', 'tissue.prostate.young_kPa=8'];
const test = inOrder();
const { folder, remove } = makeFolder();
let server, browser, withoutGl, holder;
const shown = { holder: {}, late: {} };

/** The largest displacement [mm] of the newest frame that has one, and whether the newest frame is paused. */
function watchDisplacement(page, newest) {
  page.on('websocket', (socket) => socket.on('framereceived', ({ payload }) => {
    if (payload.readUInt32LE(0) !== FRAME) return;
    newest.paused = (payload.readUInt32LE(16) & PAUSED) !== 0;
    const nodes = payload.readUInt32LE(160);
    if (nodes === 0) return;
    const unit = payload.readFloatLE(128);
    const short = (payload.readUInt32LE(16) & SHORT_DISPLACEMENT) !== 0;
    const u = (i) => unit * (short ? payload.readInt8(payload.length - 3 * nodes + i) : payload.readInt16LE(payload.length - 6 * nodes + 2 * i));
    newest.largest = 0;
    for (let i = 0; i < 3 * nodes; i += 3) newest.largest = Math.max(newest.largest, Math.hypot(u(i), u(i + 1), u(i + 2)));
  }));
}

before(async () => {
  server = await startServer(folder, { options: [...SOFT, ...SMALL] });
  browser = await openBrowser();
  withoutGl = await openBrowser({ webgl: false, pictures: false });
  holder = await openVisitor(withoutGl, server.url, { prepare: async (page) => watchDisplacement(page, shown.holder) });
  await waitUntilReady(holder.page);
});
after(async () => {
  await browser?.close();
  await withoutGl?.close();
  await server?.kill();
  remove();
});

test('a needle that rests deep in soft tissue displaces it by more than the smallest scale has', async () => {
  const { page } = holder;
  await turnWheel(page, 43);
  await untilReadout(page, 'Depth', (depth) => depth === 40);
  await until('a displacement', () => shown.holder.largest, (largest) => largest > 2 * SMALLEST_SCALE_MM);
  await page.keyboard.press('Space');
  await until('the pause', () => shown.holder.paused, Boolean);
  assert.ok(shown.holder.largest > 2 * SMALLEST_SCALE_MM, `${shown.holder.largest} mm`);
});

test('who comes during the pause finds a scale that ends with the first mark beyond it', async () => {
  const { page, problems } = await openVisitor(browser, server.url, { prepare: async (p) => watchDisplacement(p, shown.late) });
  await waitUntilReady(page);
  await marked(page, '3D view');
  await page.getByText('View', { exact: true }).click();
  await page.getByLabel('Displacement').check();
  const marks = (await page.locator('.view-scale .ticks span').allTextContents()).map(Number);
  const { largest, paused } = shown.late;
  assert.ok(paused && largest > 2 * SMALLEST_SCALE_MM, `it is shown ${largest} mm, ${paused ? '' : 'not '}paused`);
  assert.ok(marks.at(-1) >= largest && marks.at(-2) < largest, `marks ${marks} for ${largest} mm`);
  assert.deepEqual([...problems, ...holder.problems], []);
  await page.close();
});
