// SPDX-License-Identifier: GPL-3.0-or-later
// A proxy between pages and a server that lets through so many bytes a second to the pages.
import net from 'node:net';

const TURN_MS = 10;
const KEPT_BYTES = 8192;  // the proxy reads no more from the server while it has so much for a page

/**
 * @param port of the server, on this machine
 * @param bytesPerSecond to all pages together
 * @returns port, passed() [bytes to pages so far], limit(bytesPerSecond), hold(is_held): nothing passes in either
 * direction, close()
 */
export async function startProxy(port, bytesPerSecond) {
  let rate = bytesPerSecond;
  let passed = 0;
  let credit = 0;
  let last = performance.now();
  let held = false;
  const links = new Set();
  const proxy = net.createServer({ noDelay: true }, (page) => {
    const server = net.connect({ port, host: '127.0.0.1', noDelay: true });
    const link = { page, server, waiting: [], bytes: 0 };
    links.add(link);
    server.on('data', (data) => {
      link.waiting.push(data);
      link.bytes += data.length;
      if (link.bytes >= KEPT_BYTES) server.pause();
    });
    page.on('data', (data) => server.write(data));
    if (held) page.pause();
    const end = () => {
      links.delete(link);
      page.destroy();
      server.destroy();
    };
    for (const socket of [page, server]) socket.on('close', end).on('error', end);
  });
  const timer = setInterval(() => {
    const now = performance.now();
    credit = Math.min(credit + (rate * (now - last)) / 1000, (rate * 3 * TURN_MS) / 1000 + 1500);
    last = now;
    for (const link of held ? [] : links) {
      while (credit >= 1 && link.waiting.length > 0) {
        const data = link.waiting.shift();
        const piece = data.subarray(0, Math.floor(credit));
        if (piece.length < data.length) link.waiting.unshift(data.subarray(piece.length));
        link.page.write(piece);
        link.bytes -= piece.length;
        credit -= piece.length;
        passed += piece.length;
      }
      if (link.bytes < KEPT_BYTES) link.server.resume();
    }
  }, TURN_MS);
  await new Promise((resolve) => proxy.listen(0, '127.0.0.1', resolve));
  return {
    port: proxy.address().port,
    passed: () => passed,
    limit: (bytes) => (rate = bytes),
    hold(is_held) {
      held = is_held;
      for (const { page } of links) held ? page.pause() : page.resume();
    },
    close() {
      clearInterval(timer);
      for (const { page, server } of links) {
        page.destroy();
        server.destroy();
      }
      proxy.close();
    },
  };
}
