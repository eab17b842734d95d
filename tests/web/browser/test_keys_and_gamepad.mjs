// SPDX-License-Identifier: GPL-3.0-or-later
// Moves the needle without a mouse: with keys and with a gamepad.
import assert from 'node:assert/strict';
import { keepPicture, listenToEvents, readout, until, untilReadout, waitUntilReady } from './browser.mjs';
import { stage } from './stage.mjs';

const FRAME = 2;  // docs/live_protocol.md
let page, problems;

/** A gamepad with the standard mapping: four axes and seventeen buttons. */
function bringGamepad() {
  window.pad = { connected: false, axes: [0, 0, 0, 0], buttons: Array.from({ length: 17 }, () => ({ pressed: false, value: 0 })) };
  navigator.getGamepads = () => [null, window.pad.connected ? window.pad : null];
}

const { test } = stage({
  async prepare(p) {
    watchFrames(p);
    await p.addInitScript(bringGamepad);
  },
  async ready(set) {
    ({ page, problems } = set);
    await waitUntilReady(page);
  },
});

const pose = () => page.locator('.pose').textContent();
/** From the newest frame the number of steps and whether it is paused; and all depths. */
const newest = { steps: 0, paused: false };
const depths = [];
function watchFrames(p) {
  p.on('websocket', (socket) => socket.on('framereceived', ({ payload }) => {
    if (payload.readUInt32LE(0) !== FRAME) return;
    newest.paused = (payload.readUInt32LE(16) & 1) !== 0;
    newest.steps = payload.readUInt32LE(36);
    depths.push(payload.readFloatLE(44));
  }));
}

test('arrow keys push and pull as long as they are held', async () => {
  const heard = await listenToEvents(page);
  const start = await readout(page, 'Depth');
  await page.keyboard.down('ArrowUp');
  const deep = await untilReadout(page, 'Depth', (depth) => depth > 6);
  await page.keyboard.up('ArrowUp');
  assert.ok(deep > start);
  // After the key is released the needle stops: two equal depths, and the base has not been drawn back.
  let last = NaN;
  await until('rest', () => readout(page, 'Depth'), (depth) => depth === last || ((last = depth), false));
  await page.waitForTimeout(500);
  const back = depths.reduce((most, depth, i) => Math.max(most, i > 0 ? depths[i - 1] - depth : 0), 0);
  assert.equal(back, 0, `the base was drawn back by ${back} mm`);
  assert.deepEqual((await heard()).filter((text) => text.startsWith('Drawn back')), []);
  await page.keyboard.down('s');
  await untilReadout(page, 'Depth', (depth) => depth < last - 3);
  await page.keyboard.up('s');
  await page.keyboard.press('PageUp');
  await page.keyboard.press('PageUp');
  await untilReadout(page, 'Depth', (depth) => depth > 5);
});

test('other keys turn the bevel, tilt the hub and choose the speed', async () => {
  await page.keyboard.down('e');
  await until('a turned bevel', pose, (text) => Number(/Bevel (-?\d+)°/.exec(text)[1]) > 10);
  await page.keyboard.up('e');
  await page.keyboard.down('d');
  await until('a tilted hub', pose, (text) => Number(/hub ([\d.]+)° left/.exec(text)?.[1]) > 0.3);
  await page.keyboard.up('d');
  await page.keyboard.press('Home');
  await until('a straight hub', pose, (text) => /hub 0\.0°/.test(text));
  await page.keyboard.press('3');
  assert.equal(await page.getByRole('button', { name: '50', exact: true }).getAttribute('aria-pressed'), 'true');
});

test('the space bar pauses, a point makes one step', async () => {
  await page.keyboard.press('Space');
  await page.getByRole('button', { name: 'Resume' }).waitFor();
  await until('the pause', () => page.locator('.readouts').textContent(), (text) => text.includes('paused'));
  await keepPicture(page, 'paused');
  const depth = await readout(page, 'Depth');
  await page.keyboard.press('ArrowUp');
  await page.getByText('The simulation is paused.').waitFor();
  assert.equal(await readout(page, 'Depth'), depth);
  await until('a frame of the pause', () => newest.paused, Boolean);
  const { steps } = newest;
  await page.keyboard.press('.');
  await until('a step', () => newest.steps, (now) => now === steps + 1);
  await page.getByRole('button', { name: 'Step' }).click();
  await until('another step', () => newest.steps, (now) => now === steps + 2);
  await page.keyboard.press('Space');
  await page.getByRole('button', { name: 'Pause' }).waitFor();
  await page.keyboard.press('r');
  await untilReadout(page, 'Depth', (d) => d === -3);
});

test('the question mark lists all keys', async () => {
  await page.keyboard.press('?');
  await page.getByText('Pushing the needle').waitFor();
  await keepPicture(page, 'help');
  await page.keyboard.press('Escape');
  await page.getByText('Pushing the needle').waitFor({ state: 'hidden' });
});

test('the tab key comes to every control, in the order in which they are read', async () => {
  // On a slow machine there may be a notice, which goes after some seconds.
  await page.getByLabel('Close this notice').evaluateAll((buttons) => buttons.forEach((close) => close.click()));
  await page.evaluate(() => document.activeElement?.blur());
  const wanted = await page.evaluate(() => [...document.querySelectorAll('button, select, input, summary, a[href], [tabindex="0"]')]
    .filter((e) => !e.disabled && e.checkVisibility() && !e.closest('dialog:not([open])')).length);
  const reached = [];
  for (let i = 0; i < wanted + 5; i++) {
    await page.keyboard.press('Tab');
    const found = await page.evaluate(() => {
      const e = document.activeElement;
      if (!e || e === document.body) return null;
      if (e.dataset.reached) return 'again';
      e.dataset.reached = 'yes';
      return e.getAttribute('aria-label') ?? e.textContent;
    });
    if (found === null || found === 'again') break;
    reached.push(found);
  }
  assert.equal(reached.length, wanted, `reached: ${reached.join(' | ')}`);
  for (const name of ['Recordings', 'Picture', 'Keys and help', 'Hole e3.5, planned', 'Pause', 'Start again', 'Push ▶']) {
    assert.ok(reached.includes(name), `${name} is not among ${reached.join(' | ')}`);
  }
});

test('a focused hole is left by arrows and chosen by Enter', async () => {
  await page.locator('.hole[tabindex="0"]').focus();
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('Enter');
  await page.getByText('Template, needle in E3.5').waitFor();
  await waitUntilReady(page);
  await page.evaluate(() => document.activeElement?.blur());
});

test('a gamepad pushes with its left stick and turns the bevel with its shoulders', async () => {
  await page.evaluate(() => {
    window.pad.connected = true;
    window.dispatchEvent(new Event('gamepadconnected'));
    window.pad.axes[1] = -1;
  });
  await untilReadout(page, 'Depth', (depth) => depth > 8);
  await page.evaluate(() => (window.pad.axes[1] = 0.05));  // sticks do not return to exactly 0
  let last = NaN;
  await until('rest', () => readout(page, 'Depth'), (depth) => depth === last || ((last = depth), false));
  await page.evaluate(() => (window.pad.buttons[5].value = 1));
  await until('a turned bevel', pose, (text) => Number(/Bevel (-?\d+)°/.exec(text)[1]) > 20);
  await page.evaluate(() => (window.pad.buttons[5].value = 0));
  await page.evaluate(() => (window.pad.buttons[6].value = 0.8));  // the left trigger pulls
  await untilReadout(page, 'Depth', (depth) => depth < last - 2);
  assert.deepEqual(problems, []);
});
