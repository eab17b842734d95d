// SPDX-License-Identifier: GPL-3.0-or-later
// An implant in the page: a row of seeds is dropped with the keys, D90 appears, seeds move with the tissue, a drop is
// taken back, the next needle comes at once, the result says why the seeds are off, a recording shows the seeds again, and
// after its server was killed the implant goes on.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readdirSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { keepPicture, openVisitor, readout, until, waitUntilReady } from './browser.mjs';
import { startServer } from './server.mjs';
import { stage } from './stage.mjs';

const SCENARIO = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../../../scenarios/implant.toml');
const [STATUS, PLAN, IMPLANT, SEEDS] = [3, 7, 8, 9];  // docs/live_protocol.md
let page, problems;
const newest = {};  // the newest message of each kind

const listen = async (p) => p.on('websocket', (socket) => socket.on('framereceived', ({ payload }) => {
  const kind = payload.readUInt32LE(0);
  if ([STATUS, PLAN, IMPLANT, SEEDS].includes(kind)) newest[kind] = JSON.parse(payload.subarray(8).toString());
}));

// The scenario's needles are preloaded; here each seed is pushed out by itself. In software the 3D view takes most of the
// time; it is there for pictures only.
const set = stage({
  scenario: SCENARIO, options: ['--set', 'procedure.technique="pushed"'], prepare: listen,
  ready: async () => ({ page, problems } = set),
});
const { test, folder } = set;

/** The number of a figure of the plan, by its name. */
async function planFigure(name) {
  return Number(await page.locator('#implant .figure').filter({ hasText: name }).locator('b').textContent());
}
const notice = (text) => page.locator('.notice', { hasText: text }).first().waitFor();
const dropped = () => planFigure('Seeds');

/** The text that stylet info prints about the recording of a needle. */
function info(recordings, needle) {
  const name = readdirSync(recordings).filter((file) => file.endsWith(`-${needle}`)).sort()[0];
  const program = process.env.STYLET ?? path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../../../build/bin/stylet');
  return JSON.parse(execFileSync(program, ['info', path.join(recordings, name, 'run.h5'), '--json', '-']));
}

/** Moves the needle to its next seed with a key and waits until it is in place and, as a hand does, a moment longer. */
async function goToSeed() {
  await page.keyboard.press('g');
  await page.locator('.todo.in-place').waitFor();
  await page.waitForTimeout(300);
}

/** Waits for the needle and for the displacement of the tissue, without which nothing moves in pictures and recordings. */
async function waitUntilTissueMoves() {
  await waitUntilReady(page);
  await until('the displacement field', () => newest[STATUS], (status) => status?.state === 'ready' && status.stage === '');
}

test('the plan is shown with its first needle', async () => {
  await waitUntilTissueMoves();
  assert.equal(await page.locator('.plan-needle').count(), 22);
  assert.match(await page.locator('.todo').textContent(), /^Needle \S+, seed 1 of \d: push in/);
  assert.match(await page.locator('#implant').textContent(), /of 84/);
  const room = await page.locator('#implant').evaluate((e) => ({
    down: e.scrollHeight - e.clientHeight, across: e.scrollWidth - e.clientWidth,
    list: e.querySelector('.needles').scrollHeight - e.querySelector('.needles').clientHeight,
  }));
  assert.ok(Object.values(room).every((hidden) => hidden <= 1), `nothing of the panel is hidden: ${JSON.stringify(room)}`);
  await keepPicture(page, 'implant-start');
});

test('a seed cannot be dropped in air', async () => {
  await page.keyboard.press('d');
  await notice('its tip is not in the tissue');
  assert.equal(await dropped(), 0);
});

test('a row of seeds is dropped, and D90 rises with each', async () => {
  await page.keyboard.press('3');
  const needle = newest[PLAN].needles[newest[PLAN].current];
  let before = 0;
  const took = [];  // [ms] from each drop to its D90
  for (let k = 1; k <= needle.seeds.length; k++) {
    await goToSeed();
    await page.keyboard.press('d');
    await until(`seed ${k}`, dropped, (count) => count === k);
    await until('its dose', () => newest[IMPLANT], (implant) => implant.now?.seeds === k);
    const d90 = newest[IMPLANT].now.d90_Gy;
    assert.ok(d90 > before, `D90 ${d90} Gy after ${before} Gy`);
    took.push(newest[IMPLANT].now.took_ms);
    before = d90;
  }
  const { d90_percent } = newest[IMPLANT].now;
  await until(`D90 of ${d90_percent} %`, () => planFigure('D90'), (percent) => Math.abs(percent - d90_percent) < 0.06);
  assert.match(await page.locator('.todo').textContent(), /is empty/);
  console.log(`D90 took ${took.map((ms) => ms.toFixed(0)).join(', ')} ms`);
  await keepPicture(page, 'implant-row');
});

test('the seeds have moved with the tissue and go back when the needle is drawn out', async () => {
  const now = (i) => newest[SEEDS].now_mm[i];
  const off = ({ rest_mm }, i) => Math.hypot(...rest_mm.map((x, k) => x - now(i)[k]));
  const away = () => Math.max(...newest[IMPLANT].seeds.map(off));
  await until('displaced seeds', away, (mm) => mm > 0.5);
  for (let pulls = 0; pulls < 30 && (await readout(page, 'Depth')) > -3; pulls++) {
    await page.keyboard.press('PageDown');
    await page.waitForTimeout(150);
  }
  await until('seeds at rest', away, (mm) => mm < 0.5);
});

test('the last drop can be taken back and repeated', async () => {
  const count = await dropped();
  const d90 = newest[IMPLANT].now.d90_Gy;
  await page.keyboard.press('Control+z');
  await until('one seed less', dropped, (now) => now === count - 1);
  await until('its dose', () => newest[IMPLANT].now, (now) => now.seeds === count - 1 && now.d90_Gy < d90);
  await goToSeed();
  await page.keyboard.press('d');
  await until('the seed again', dropped, (now) => now === count);
});

test('the next needle comes, and the seeds stay', async () => {
  const count = await dropped();
  const first = newest[PLAN].current;
  await until('the model of the next needle', () => newest[PLAN].needles[first + 1].ready, Boolean);
  const begun = Date.now();
  await page.keyboard.press('n');
  await until('the next needle', () => newest[PLAN].current, (current) => current === first + 1);
  const took = Date.now() - begun;
  console.log(`The next needle took ${took} ms`);
  await until('the needle before the skin', () => readout(page, 'Depth'), (depth) => depth < 0);
  assert.equal(await dropped(), count);
  await goToSeed();
  await page.keyboard.press('d');
  const last = () => newest[IMPLANT].seeds.at(-1).needle;
  await until('a seed of the second needle', last, (needle) => needle === first + 1);
});

test('the result says how far the seeds are off, and why', async () => {
  await page.getByRole('button', { name: 'Result' }).click();
  const card = page.locator('dialog.end-card');
  await card.waitFor();
  const text = await card.textContent();
  const parts = ['of 84 seeds have been dropped', 'D90', 'Mean error', 'Superior–inferior', 'Tissue motion', 'Your hand',
    'Not a medical device'];
  for (const part of parts)
    assert.ok(text.includes(part), `${part} is missing in ${text}`);
  assert.match(text, /All needles so farSkin broken(twice|\d times)Rectum/);
  await keepPicture(page, 'implant-result');
  await page.getByRole('button', { name: 'Go on' }).click();
});

test('a recording of a needle shows the seeds of each moment, and its panel cannot be used', async () => {
  const live = newest[IMPLANT];
  const shown = () => newest[IMPLANT].seeds.length;
  const first = newest[PLAN].needles[live.seeds[0].needle];
  await page.waitForTimeout(1000);  // recordings are written to the disk five times a second
  await page.getByRole('button', { name: 'Recordings' }).click();
  const rows = page.locator('dialog table tr').filter({ has: page.getByRole('button', { name: 'Replay' }) });
  // The recording of the first needle that dropped seeds, with which the page began.
  await rows.filter({ has: page.getByRole('cell', { name: new RegExp(`-${first.name}$`) }) }).getByRole('button', { name: 'Replay' }).last().click();
  await page.locator('#replay').waitFor();
  await page.locator('.todo', { hasText: /^Recording\. Needle/ }).waitFor();
  await until('no seed at its start', shown, (count) => count === 0);
  const time = page.getByLabel('Time of the recording');
  const seek = (seconds) => time.evaluate((input, to) => {
    input.value = String(to);
    input.dispatchEvent(new Event('input'));
    input.dispatchEvent(new Event('change'));
  }, seconds);
  const end = Number(await time.getAttribute('max'));
  await seek(end);
  await until('all its seeds', shown, (count) => count === first.seeds.length);
  // Going back in time, seeds disappear; at the moment of its drop a seed is where the needle has left it.
  const dropped_seeds = newest[IMPLANT].seeds;
  const { acts } = info(path.join(folder, 'live'), first.name).implant;
  const off = [];
  for (let k = first.seeds.length - 1; k >= 0; k--) {
    // A seed that was taken back and dropped again has two drops; the last one stays.
    const at = acts.filter((act) => act.kind === 'dropped' && act.number === dropped_seeds[k].number + 1).at(-1).time_s;
    await seek(at + 0.02);
    await until('its seeds', shown, (count) => count === k + 1);
    await until('their places', () => newest[SEEDS].now_mm.length, (count) => count === k + 1);
    off.push(Math.hypot(...dropped_seeds[k].dropped_mm.map((x, i) => x - newest[SEEDS].now_mm[k][i])));
  }
  console.log(`At their drops the replay shows seeds ${off.map((mm) => mm.toFixed(2)).join(', ')} mm from where they were dropped`);
  assert.ok(Math.max(...off) < 1, `${off} mm`);
  assert.ok(newest[IMPLANT].now.d90_Gy > 0);
  await page.locator('.todo', { hasText: `1 of ${first.seeds.length} seeds dropped` }).waitFor();
  assert.equal(await page.locator('#implant button:visible').filter({ hasText: /Drop|Go there|Take back|Next/ }).count(), 0);
  await keepPicture(page, 'implant-replay');
  await page.keyboard.press('u');
  await page.getByRole('button', { name: 'Back to the live needle' }).click();
  await until('the live seeds', () => newest[IMPLANT], (now) => now.seeds.length === live.seeds.length && now.now?.goals.length > 0);
  assert.deepEqual(newest[IMPLANT].seeds, live.seeds);
  assert.deepEqual(problems, []);
});

/** Opens the page of another server, which has the same recordings. */
async function restart(options, signal) {
  await page.close();
  await set.server.kill(signal);
  set.server = await startServer(folder, { scenario: SCENARIO, options });
  for (const kind of [STATUS, PLAN, IMPLANT, SEEDS]) delete newest[kind];
  ({ page, problems } = await openVisitor(set.browser, set.server.url, { prepare: listen }));
}

test('after its server was killed the implant is offered, and goes on with the same seeds and dose', async () => {
  const before = newest[IMPLANT];
  const { name } = newest[PLAN].needles[newest[PLAN].current];
  await restart(['--set', 'procedure.technique="pushed"'], 'SIGKILL');
  const offer = page.locator('dialog.offer');
  await offer.getByText(new RegExp(`^Go on with the implant of ${before.seeds.length} of 84 seeds from \\d+ \\w+, \\d\\d:\\d\\d\\?$`)).waitFor();
  await keepPicture(page, 'implant-offer');
  await page.setViewportSize({ width: 390, height: 844 });
  const { x, width } = await offer.boundingBox();
  assert.ok(x >= 0 && x + width <= 390, `the question is within a narrow page: ${x} to ${x + width}`);
  await keepPicture(page, 'implant-offer-narrow');
  await page.setViewportSize({ width: 1366, height: 768 });
  await page.reload();
  await offer.getByRole('button', { name: 'Go on' }).click();
  await until('the seeds', () => newest[IMPLANT], (now) => now.seeds.length === before.seeds.length && now.now?.goals.length > 0);
  newest[IMPLANT].seeds.forEach(({ rest_mm, why }, k) => {
    const was = before.seeds[k];
    const pairs = [[rest_mm, was.rest_mm], ...Object.keys(was.why).map((cause) => [why[cause], was.why[cause]])];
    for (const [is, then] of pairs) assert.ok(is.every((x, i) => Math.abs(x - then[i]) < 1.1e-3), `${is} instead of ${then}`);
  });
  assert.ok(Math.abs(newest[IMPLANT].now.d90_Gy / before.now.d90_Gy - 1) < 1e-3);
  assert.equal(newest[IMPLANT].error.seeds, before.seeds.length);
  assert.deepEqual(newest[IMPLANT].tally, before.tally);
  await until('its needle', () => newest[PLAN], (plan) => plan.needles[plan.current].name === name);
  await until('the needle before the skin', () => readout(page, 'Depth'), (depth) => depth < 0);
  await offer.waitFor({ state: 'hidden' });
  await page.getByRole('button', { name: 'Recordings' }).click();
  await page.locator('dialog td', { hasText: /^\d+ of 84 seeds, D90 [\d.]+ %/ }).first().waitFor();
  await keepPicture(page, 'implant-recordings');
  assert.deepEqual(problems, []);
});

test('a preloaded needle leaves its train as it is drawn back; a lost seed is said', async () => {
  await restart(['--set', 'seed.loss_percent=100']);
  await page.getByRole('button', { name: 'Begin anew' }).click();
  await waitUntilTissueMoves();
  await until('no seeds', () => newest[IMPLANT].seeds.length, (count) => count === 0);
  await page.keyboard.press('3');
  assert.match(await page.locator('.todo').textContent(), /train of \d seeds: push in/);
  await goToSeed();
  await page.keyboard.press('d');
  await page.locator('.todo', { hasText: ': draw back' }).waitFor();  // 'Drop, then draw back' is said before
  await keepPicture(page, 'implant-train');
  await page.keyboard.press('g');
  const { seeds } = newest[PLAN].needles[newest[PLAN].current];
  await until('the train', async () => ({
    left: newest[IMPLANT].seeds.length, from: newest[IMPLANT].train_from_mm, depth: await readout(page, 'Depth'),
    todo: await page.locator('.todo').textContent(), notices: await page.locator('.notice').allTextContents(),
  }), ({ left }) => left === seeds.length);
  await notice('is lost: it has left the patient');
  assert.match(await page.locator('#implant').textContent(), new RegExp(`${seeds.length} lost`));
  await keepPicture(page, 'implant-lost');
  assert.deepEqual(problems, []);
});
