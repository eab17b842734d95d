// SPDX-License-Identifier: GPL-3.0-or-later
// A first visit of the page: turns the wheel, clicks a hole, and drags everything that can be dragged.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before } from 'node:test';
import {
  figure, inOrder, keepPicture, listenToEvents, marked, openBrowser, openVisitor, readout, skipWithoutChromium, turnWheel, until, untilReadout, waitUntilReady,
} from './browser.mjs';
import { shadesOf } from './png.mjs';
import { makeFolder, startServer } from './server.mjs';

const LONGEST_STEP_S = 0.0041;  // a step covers at most three missed steps

skipWithoutChromium();
const test = inOrder();
const { folder, remove } = makeFolder();
let server, browser, page, problems, heard;

before(async () => {
  server = await startServer(folder);
  browser = await openBrowser();
  ({ page, problems } = await openVisitor(browser, server.url));
});
after(async () => {
  await browser?.close();
  await server?.kill();
  remove();
});

/** The content of a file that the page downloads. */
async function download(action) {
  const [file] = await Promise.all([page.waitForEvent('download'), action()]);
  return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
}

/** Turns the wheel until a condition holds. */
async function turnUntil(notches, what, happened) {
  for (let turns = 0; turns < 60 && !(await happened()); turns++) await turnWheel(page, notches);
  await until(what, happened, Boolean);
}

test('the page opens with the needle before the skin', async () => {
  await waitUntilReady(page);
  assert.equal(await readout(page, 'Axial'), 0);
  assert.ok((await readout(page, 'Depth')) < 0, 'the needle is before the skin');
  assert.equal(await figure(page, 'Tip off its target'), NaN, 'the tip is not in the tissue');
  heard = await listenToEvents(page);
  await marked(page, '3D view');
  await keepPicture(page, 'start');
  await page.getByText("The picture of the tissue's motion is being prepared").waitFor({ state: 'hidden' });
});

test('the wheel pushes the needle: skin and capsule resist, then give way', async () => {
  const said = async (word) => (await heard()).find((text) => text.startsWith(word));
  const before = [];
  await turnUntil(3, 'the capsule to be punctured', async () => {
    before.push(await readout(page, 'Axial'));
    return said('Entered the prostate');
  });
  assert.ok(await said('Touched the skin') && await said('Went through the skin'));
  const peak = Number(/([\d.]+) N$/.exec(await said('Entered the prostate'))[1]);
  const first = before.find((force) => force > 0.02);
  assert.ok(before[0] === 0 && first < peak && Math.max(...before) > first, `the force rises: ${before}, ${peak} N at the capsule`);
  await untilReadout(page, 'Axial', (force) => force < 0.9 * peak && force > 0);
});

test('the gland moves with the needle', async () => {
  await turnUntil(3, 'the tip within the gland', async () => (await readout(page, 'Depth')) > 55);
  const error = await figure(page, 'Tip off its target');
  assert.ok(error > 1 && error < 20, `the tip is off its target by ${error} mm`);
  assert.match(await page.locator('.figure').filter({ hasText: 'Tip off its target' }).getAttribute('title'), /mm inferior, .* mm (left|right)\. It is not the error of a seed/);
  await keepPicture(page, 'inserted');
  await page.getByText('View', { exact: true }).click();
  await page.getByLabel('Displacement').check();
  await until('a scale for what has moved', () => page.locator('.view-scale .ticks span').last().textContent(), (most) => Number(most) > 0.5);
  await keepPicture(page, 'displacement');
  await page.getByLabel('Tissue').check();
  await page.getByText('View', { exact: true }).click();
});

test('a picture can be kept', async () => {
  const { name, bytes } = await download(() => page.getByRole('button', { name: 'Picture' }).click());
  assert.match(name, /^stylet-.*\.png$/);
  const { width, height, shades } = shadesOf(bytes);
  assert.deepEqual([width, height], [1920, 1200]);
  // The parts of the picture: 3D view and sections above, the curve below.
  for (const [part, count] of Object.entries(shades)) assert.ok(count > 40, `${part} of the picture has ${count} shades`);
});

test('withdrawing turns the force round, until the needle is out', async () => {
  await page.getByRole('button', { name: '50', exact: true }).click();
  await turnWheel(page, -6);
  await untilReadout(page, 'Axial', (force) => force < 0);
  await turnUntil(-20, 'the tip before the skin', async () => (await readout(page, 'Depth')) < 0);
  await until('the last event', async () => (await heard()).join('; '), (said) => /Drawn back.*Slips.*Out of the patient/.test(said));
  await until('a needle in the air', () => page.locator('.readouts').textContent(), (text) => text.includes('in air'));
  await untilReadout(page, 'Axial', (force) => force === 0);
});

test('a click on another hole puts the needle there', async () => {
  await page.getByLabel('Hole c3.5', { exact: true }).click();
  await page.getByText('Template, needle in c3.5').waitFor();
  await waitUntilReady(page);
  await untilReadout(page, 'Depth', (depth) => depth < 0);
});

test('the insertion can be replayed, its time slider dragged, and its curve saved', async () => {
  await page.getByRole('button', { name: 'Recordings' }).click();
  await page.locator('dialog tr').first().waitFor();
  const rows = page.locator('dialog tr').filter({ has: page.getByRole('button', { name: 'Replay' }) });
  assert.equal(await rows.count(), 2, 'one recording for each hole');
  await rows.filter({ hasText: 'e3.5' }).getByRole('button', { name: 'Replay' }).click();
  await page.locator('#replay').waitFor();
  await until('the curve', () => page.locator('#replay output').textContent(), (text) => /of \d/.test(text));
  const slider = page.getByLabel('Time of the recording');
  const time = page.locator('#replay output');
  const box = await slider.boundingBox();
  const drag = (share) => page.mouse.move(box.x + 8 + share * box.width, box.y + box.height / 2);
  await drag(0);
  await page.mouse.down();
  const first = await readout(page, 'Depth');
  for (let k = 1; k <= 12; k++) {
    const shown = await time.textContent();
    await drag((0.7 * k) / 12);
    await until('the time of the slider', () => time.textContent(), (text) => text !== shown);
  }
  await untilReadout(page, 'Depth', (depth) => depth > 10);
  await drag(0);
  await untilReadout(page, 'Depth', (depth) => depth === first);
  await drag(0.7);
  await untilReadout(page, 'Depth', (depth) => depth > 10);
  await page.mouse.up();
  assert.equal(await figure(page, 'Tip off its target'), NaN, 'a recording does not have it');
  await keepPicture(page, 'replay');

  const { name, bytes } = await download(() => page.locator('#replay').getByText('CSV').click());
  assert.match(name, /e3\.5.*\.csv$/);
  const lines = bytes.toString().trimEnd().split('\n');
  const columns = lines[0].split(',');
  for (const name of ['time_s', 'force_axial_N', 'tip_z_mm', 'step_us']) assert.ok(columns.includes(name), lines[0]);
  assert.ok(lines.every((line) => line.split(',').length === columns.length));
  // Every step from the first to the last is there; a late step covers the milliseconds that were missed.
  const seconds = Number(await slider.getAttribute('max'));
  const times = lines.slice(1).map((line) => Number(line.split(',')[0]));
  assert.ok(times[0] <= LONGEST_STEP_S && Math.abs(times.at(-1) - seconds) < 1e-3, `from ${times[0]} to ${times.at(-1)} of ${seconds} s`);
  // Of a rest the first and the last step are there. All columns before those about the solver are equal in both.
  const needleOf = (line) => line.split(',').slice(1, columns.indexOf('iterations')).join();
  const isRest = (i) => needleOf(lines[i]) === needleOf(lines[i + 1]);
  const gap = times.findIndex((time, i) => i > 0 && !(time > times[i - 1] && (time < times[i - 1] + LONGEST_STEP_S || isRest(i))));
  assert.equal(gap, -1, `a gap after ${times[gap - 1]} s`);
});

test('back to the live needle', async () => {
  await page.getByRole('button', { name: 'Back to the live needle' }).click();
  await page.locator('#push').waitFor();
  await waitUntilReady(page);
  await page.getByText('Template, needle in c3.5').waitFor();
  await turnUntil(3, 'the skin to be touched', async () => (await readout(page, 'Depth')) > 1);
  assert.deepEqual(problems, []);
});
