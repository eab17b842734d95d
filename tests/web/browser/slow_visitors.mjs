// SPDX-License-Identifier: GPL-3.0-or-later
// Measures how old the picture of a page is behind a slow connection while its needle moves, and what an idle patient
// costs. Prints a table.
//   node tests/web/browser/slow_visitors.mjs [SECONDS]
import { openBrowser, openVisitor, skipWithoutChromium, until, waitUntilReady } from './browser.mjs';
import { makeFolder, startServer } from './server.mjs';
import { startProxy } from './slow_proxy.mjs';

const FRAME = 2;
const RATES = [60, 250, 1000, Infinity];  // [kB/s]
const IDLE_S = 5;
const seconds = Number(process.argv[2] ?? 20);
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

skipWithoutChromium();
const { folder, remove } = makeFolder();
const server = await startServer(folder);
const browser = await openBrowser({ webgl: false });

/** Hears the pictures of a page's connection. */
function hear(page, onFrame) {
  page.on('websocket', (socket) => socket.on('framereceived', ({ payload }) => {
    if (typeof payload !== 'string' && payload.readUInt32LE(0) === FRAME) onFrame(payload.readDoubleLE(8), payload.length, payload.readFloatLE(44));
  }));
}

const quantile = (values, q) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(q * values.length))];

// A page beside the proxy tells what the simulated time is now: by its newest pictures, the fastest of the last seconds.
const CLOCK_S = 2;
let clock = [];
const direct = await openVisitor(browser, server.url, {
  prepare: async (page) => hear(page, (time) => {
    const at = performance.now() / 1000;
    clock = [...clock.filter((c) => c.at > at - CLOCK_S), { at, ahead: time - at }];
  }),
});
await waitUntilReady(direct.page);
await direct.page.getByText('You hold the needle').waitFor();
const now_s = () => performance.now() / 1000 + Math.max(...clock.map((c) => c.ahead));

/** kB/s through a proxy while nothing moves. */
async function idle(proxy) {
  await pause(3000);
  const before = proxy.passed();
  await pause(1000 * IDLE_S);
  return ((proxy.passed() - before) / IDLE_S / 1000).toFixed(1);
}

console.log('          age of the picture [s]                            at rest [kB/s]');
console.log('kB/s      median   95 %     pictures/s   bytes/picture      skin     tissue');
for (const rate of RATES) {
  const proxy = await startProxy(server.port, 1000 * Math.min(rate, 1e6));
  const address = new URL(server.url);
  address.port = String(proxy.port);
  let newest = NaN;
  let depth = NaN;
  const sizes = [];
  const { page } = await openVisitor(browser, address.href, {
    prepare: async (p) => hear(p, (time, bytes, atDepth) => {
      newest = time;
      depth = atDepth;
      sizes.push(bytes);
    }),
  });
  await waitUntilReady(page);
  // The page behind the proxy gets the needle.
  await page.getByRole('button', { name: 'Ask for the needle' }).click();
  await direct.page.getByRole('button', { name: 'Hand over' }).click();
  await page.getByText('You hold the needle').waitFor();
  await until('the pictures to be new', () => now_s() - newest, (age) => age < 1.5);

  const atSkin = await idle(proxy);
  await page.locator('body').click({ position: { x: 5, y: 5 } });
  sizes.length = 0;
  const ages = [];
  const end = performance.now() + 1000 * seconds;
  let key = 'ArrowUp';
  await page.keyboard.down(key);
  while (performance.now() < end) {
    await pause(20);
    ages.push(now_s() - newest);
    const turn = key === 'ArrowUp' ? depth > 60 : depth < 5;
    if (!turn) continue;
    await page.keyboard.up(key);
    key = key === 'ArrowUp' ? 'ArrowDown' : 'ArrowUp';
    await page.keyboard.down(key);
  }
  await page.keyboard.up(key);
  const count = sizes.length;
  const bytes = sizes.reduce((sum, size) => sum + size, 0) / count;
  const rest = await idle(proxy);
  console.log([String(rate).padEnd(10), quantile(ages, 0.5).toFixed(2).padEnd(9), quantile(ages, 0.95).toFixed(2).padEnd(9),
               (count / seconds).toFixed(1).padEnd(13), bytes.toFixed(0).padEnd(19), atSkin.padEnd(9), rest].join(''));
  await page.close();
  proxy.close();
  await direct.page.getByRole('button', { name: 'Take the needle' }).click();
  await direct.page.getByText('You hold the needle').waitFor();
  await direct.page.keyboard.press('r');
  await pause(500);
}
await browser.close();
await server.kill();
remove();
