// SPDX-License-Identifier: GPL-3.0-or-later
// Moves a needle in and out for minutes. The memory of the page and of the server must not grow.
//   node tests/web/browser/long_session.mjs SECONDS
import { openBrowser, openVisitor, readout, waitUntilReady } from './browser.mjs';
import { makeFolder, SMALL, startServer } from './server.mjs';

const MEASURES = 24;
const MB = 1e6;

/** Counts the messages of the live connection. */
function countMessages() {
  window.messages = 0;
  const listen = WebSocket.prototype.addEventListener;
  WebSocket.prototype.addEventListener = function (kind, listener) {
    return listen.call(this, kind, kind === 'message' ? (e) => (window.messages++, listener(e)) : listener);
  };
}

/** Pushes and pulls as with a key, between the skin and the gland's far end, for a time or for a number of cycles. */
async function toAndFro(page, seconds, times = Infinity) {
  const end = Date.now() + 1000 * seconds;
  let key = 'PageUp';
  for (let out = 0; Date.now() < end && out < times;) {
    const depth = await readout(page, 'Depth');
    if (depth > 60) key = 'PageDown';
    if (depth < 2) {
      if (key === 'PageDown') out++;
      key = 'PageUp';
    }
    await page.keyboard.press(key);
    await page.waitForTimeout(100);
  }
}

/**
 * @returns memory [MB] of the page's heap after garbage collection and of the server, numbers of nodes, listeners and
 * messages
 */
async function measure(page, client, server) {
  for (let i = 0; i < 2; i++) await client.send('HeapProfiler.collectGarbage');
  const { usedSize } = await client.send('Runtime.getHeapUsage');
  const { nodes, jsEventListeners } = await client.send('Memory.getDOMCounters');
  return {
    minutes: performance.now() / 60_000, heap: usedSize / MB, server: server.memory() / MB, nodes, listeners: jsEventListeners,
    messages: await page.evaluate(() => window.messages),
  };
}

/** The median of the second half of the measurements minus the median of the first half. */
function growth(measures, key) {
  const half = measures.length / 2;
  const median = (list) => list.map((m) => m[key]).sort((a, b) => a - b)[Math.floor(list.length / 2)];
  return median(measures.slice(half)) - median(measures.slice(0, half));
}

/**
 * The first quarter of the session is left out.
 * @returns growth from the first to the second half of the rest, minutes between their centres, messages per second
 */
export async function longSession(seconds, say = () => {}) {
  const { folder, remove } = makeFolder();
  const server = await startServer(folder, { options: SMALL });
  const browser = await openBrowser();
  try {
    const { page, problems } = await openVisitor(browser, server.url, { width: 800, height: 600, prepare: (p) => p.addInitScript(countMessages) });
    await waitUntilReady(page);
    await page.keyboard.press('3');
    await toAndFro(page, 120, 2); // until server and page have allocated memory for all depths
    const client = await page.context().newCDPSession(page);
    const measures = [];
    for (let i = 0; i < MEASURES; i++) {
      await toAndFro(page, seconds / MEASURES);
      measures.push(await measure(page, client, server));
      const m = measures.at(-1);
      say(`${((seconds * (i + 1)) / MEASURES).toFixed(0)} s: page ${m.heap.toFixed(2)} MB, ${m.nodes} nodes, ${m.listeners} listeners; server ${m.server.toFixed(1)} MB; ${m.messages} messages`);
    }
    const settled = measures.slice(MEASURES / 4);
    const [first, last] = [settled[0], settled.at(-1)];
    return {
      grown: Object.fromEntries(['heap', 'server', 'nodes', 'listeners'].map((key) => [key, growth(settled, key)])),
      minutes: (last.minutes - first.minutes) / 2,
      messagesPerSecond: (last.messages - first.messages) / (60 * (last.minutes - first.minutes)),
      problems,
    };
  } finally {
    await browser.close();
    await server.kill();
    remove();
  }
}

if (process.argv[1] === new URL(import.meta.url).pathname) {
  const { grown, minutes, messagesPerSecond, problems } = await longSession(Number(process.argv[2] ?? 600), console.log);
  console.log(`Grown in ${minutes.toFixed(1)} min: page ${grown.heap.toFixed(2)} MB, ${grown.nodes} nodes, ${grown.listeners} listeners; `
    + `server ${grown.server.toFixed(1)} MB. ${messagesPerSecond.toFixed(0)} messages a second, ${problems.length} complaints.`);
}
