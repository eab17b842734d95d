// SPDX-License-Identifier: GPL-3.0-or-later
// On screens from small to huge, every control is visible and can be reached with a pointer, and no text is cut off.
import assert from 'node:assert/strict';
import { keepPicture, turnWheel, until, untilReadout, waitUntilReady } from './browser.mjs';
import { stage } from './stage.mjs';

let visitor;
const { test } = stage({
  async ready(set) {
    visitor = set;
    await waitUntilReady(visitor.page);
    await turnWheel(visitor.page, 30);
    await untilReadout(visitor.page, 'Depth', (depth) => depth === 27);
    // Notices about the coarse mesh cover the curve for some seconds.
    await until('the notices to go', () => visitor.page.locator('.notice').count(), (count) => count === 0);
  },
});

/** The faults of the page's layout, in words. */
function faults() {
  const found = [];
  const name = (e) => `${e.tagName.toLowerCase()} "${(e.getAttribute('aria-label') ?? e.textContent).trim().slice(0, 40)}"`;
  for (const e of document.querySelectorAll('button, select, input, summary, a[href], .hole, .track')) {
    if (!e.checkVisibility() || e.closest('dialog:not([open])')) continue;
    const { left, right, top, bottom, width, height } = e.getBoundingClientRect();
    if (width === 0 || height === 0) found.push(`${name(e)} has no size`);
    else if (left < 0 || top < 0 || right > innerWidth + 0.5 || bottom > innerHeight + 0.5) found.push(`${name(e)} is partly off the screen`);
    else {
      const at = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
      if (at !== e && !e.contains(at) && !at?.contains(e)) found.push(`${name(e)} is covered by ${at ? name(at) : 'nothing'}`);
    }
  }
  for (const e of document.querySelectorAll('button, .value, .name, .unit, b, h1, h2, .computer, .pose, .holder, .recording, .picker-title, .picker-hint, output')) {
    if (e.checkVisibility() && e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).display !== 'inline') found.push(`${name(e)} is cut off`);
  }
  const side = document.querySelector('.side');
  if (side.scrollHeight > side.clientHeight + 1) found.push(`the column at the side is ${side.scrollHeight - side.clientHeight} px too long`);
  const parts = [...document.querySelectorAll('.top > *')].filter((e) => e.checkVisibility()).map((e) => [e, e.getBoundingClientRect()]);
  for (const [a, p] of parts) {
    for (const [b, q] of parts) {
      if (a !== b && p.left < q.left && p.right > q.left + 0.5 && p.bottom > q.top && q.bottom > p.top) found.push(`${name(a)} overlaps ${name(b)}`);
    }
  }
  return found;
}

for (const [width, height] of [[1366, 768], [1024, 700], [1280, 1024], [1920, 1080], [3840, 2160]]) {
  test(`everything is in its place on ${width} × ${height}`, async () => {
    const { page } = visitor;
    await page.setViewportSize({ width, height });
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    await keepPicture(page, `at-${width}x${height}`);
    assert.deepEqual(await page.evaluate(faults), []);
  });
}

test('on a telephone the parts are below each other, none wider than the screen', async () => {
  const { page } = visitor;
  await page.setViewportSize({ width: 412, height: 860 });
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await keepPicture(page, 'at-412x860');
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'the page scrolls sideways');
  assert.deepEqual(visitor.problems, []);
});
