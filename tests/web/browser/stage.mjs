// SPDX-License-Identifier: GPL-3.0-or-later
// Of most files of tests the stage: a server, a browser, and a page that is opened before the first test.
import { after, before } from 'node:test';
import { inOrder, openBrowser, openVisitor, skipWithoutChromium } from './browser.mjs';
import { makeFolder, SMALL, startServer } from './server.mjs';

/**
 * Called once at the beginning of a file; what it starts ends after the last test.
 * @param prepare called with the page before it is opened
 * @param ready called with the stage when the page is open
 * @returns test, for tests in their order, and folder; from `ready` on server, browser, page and problems as well
 */
export function stage({ scenario, options = SMALL, webgl = false, prepare, ready = async () => {} } = {}) {
  skipWithoutChromium();
  const { folder, remove } = makeFolder();
  const set = { test: inOrder(), folder };
  before(async () => {
    set.server = await startServer(folder, { scenario, options });
    set.browser = await openBrowser({ webgl });
    Object.assign(set, await openVisitor(set.browser, set.server.url, { prepare }));
    await ready(set);
  });
  after(async () => {
    await set.browser?.close();
    await set.server?.kill();
    remove();
  });
  return set;
}
