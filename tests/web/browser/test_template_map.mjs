// SPDX-License-Identifier: GPL-3.0-or-later
// The colours of the template's holes: clearances at once, and predictions of a needle through each hole on request.
import assert from 'node:assert/strict';
import { figure, keepPicture, turnWheel, until, untilReadout, waitUntilReady } from './browser.mjs';
import { stage } from './stage.mjs';

let page, problems;
const { test } = stage({
  async ready(set) {
    ({ page, problems } = set);
    await waitUntilReady(page);
  },
});

const choice = () => page.getByLabel('What the colours of the holes mean');
const mapped = () => page.locator('.hole .mapped:not(.unknown):not(.through)').count();
/** The text that appears when the pointer is over a hole. */
const told = (name) => page.evaluate((hole) => [...document.querySelectorAll('.hole title')].map((t) => t.textContent)
  .find((text) => new RegExp(`^(Hole )?${hole.replace('.', '\\.')}(\\n|,|$)`).test(text)), name);

test('clearances are there without being asked for', async () => {
  await choice().waitFor();
  await until('coloured holes', mapped, (count) => count > 20);
  assert.match(await told('e3.5'), /mm deep, .* in the gland\nClearance to bone: .* mm\nClearance to the urethra: .*\nClearance to the rectum: /);
  assert.match(await told('A1'), /misses the gland/);
  const ends = await page.locator('.map-scale .ticks span').allTextContents();
  assert.deepEqual(ends, ['✕ 0 mm: passes through', '20 mm or more']);
  assert.ok(await page.locator('.hole .through').count() > 0, 'ways through a structure have a cross');
  await keepPicture(page, 'template-clearance');
});

test('the colours can be changed and taken away', async () => {
  const fills = () => page.locator('.hole .mapped:not(.through)').evaluateAll((all) => all.map((e) => e.getAttribute('fill')).join());
  const nearest = await fills();
  await choice().selectOption('bone');
  assert.notEqual(await fills(), nearest);
  await choice().selectOption('');
  assert.equal(await page.locator('.hole .mapped').count(), 0);
  await choice().selectOption('tip');
  assert.equal(await mapped(), 0, 'nothing is predicted yet');
  assert.ok(await page.locator('.hole .unknown').count() > 20);
  assert.equal(await page.locator('.map-state').textContent(), 'Not predicted yet.');
});

test('predictions come one by one, the planned hole first, and can be stopped', async () => {
  await page.getByRole('button', { name: 'Predict shift' }).click();
  await until('a first prediction', mapped, (count) => count > 0);
  assert.match(await told('e3.5'), /Largest gland shift: [\d.]+ mm\nTip off its target: [\d.]+ mm/);
  assert.match(await page.locator('.map-state').textContent(), /^Hole \d+ of \d+ …$/);
  await keepPicture(page, 'template-predicted');
  await page.getByRole('button', { name: 'Stop', exact: true }).click();
  await page.getByRole('button', { name: 'Predict shift' }).waitFor();
  const count = await mapped();
  await page.waitForTimeout(3000);
  assert.ok((await mapped()) <= count + 1, 'no more than the one that was being made');
});

test('a needle that goes where one was predicted has the tip error that was predicted', async () => {
  const predicted = Number(/Tip off its target: ([\d.]+) mm/.exec(await told('e3.5'))[1]);
  const depth = Number(/([\d.]+) mm deep/.exec(await told('e3.5'))[1]);
  await turnWheel(page, Math.round(depth) + 3);
  await untilReadout(page, 'Depth', (now) => now === Math.round(depth));
  const error = await until('an error as predicted', () => figure(page, 'Tip off its target'), (now) => Math.abs(now / predicted - 1) < 0.1);
  assert.ok(predicted > 1, `${predicted} mm predicted, ${error} mm found`);
});

test('a replay has no map, and the live needle has it back', async () => {
  await page.locator('.hole', { has: page.locator('title', { hasText: /^Hole d3\.5\n/ }) }).click();
  await page.locator('.picker-title', { hasText: 'needle in d3.5' }).waitFor();
  assert.ok((await mapped()) > 0, 'another hole is the same patient');
  await page.getByRole('button', { name: 'Recordings' }).click();
  await page.getByRole('button', { name: 'Replay' }).last().click();
  await until('no colours', () => page.locator('.hole .mapped').count(), (count) => count === 0);
  await page.getByRole('button', { name: 'Back to the live needle' }).click();
  await until('colours again', mapped, (count) => count > 0);
  assert.deepEqual(problems, []);
});
