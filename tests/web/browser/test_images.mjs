// SPDX-License-Identifier: GPL-3.0-or-later
// Ultrasound and X-ray in the page: the stepper moves the probe, the needle's tip is found in the picture and its place
// read there, the picture can be frozen, the C-arm turned, and a recording looked at in the same way.
import assert from 'node:assert/strict';
import { keepPicture, readout, until, untilReadout, waitUntilReady } from './browser.mjs';
import { stage } from './stage.mjs';

const [FRAME, STATUS, IMAGE] = [2, 3, 11];  // docs/live_protocol.md
let page, problems;
let image = null;   // the newest picture: its text and its values
let status = null;
let tip = null;     // [mm] LPS
let images = 0;

const listen = async (p) => p.on('websocket', (socket) => socket.on('framereceived', ({ payload }) => {
  const kind = payload.readUInt32LE(0);
  if (kind === STATUS) status = JSON.parse(payload.subarray(8).toString());
  if (kind === FRAME) tip = [72, 76, 80].map((at) => payload.readFloatLE(at));
  if (kind !== IMAGE) return;
  const [length, rows, columns] = [8, 12, 16].map((at) => payload.readUInt32LE(at));
  image = { ...JSON.parse(payload.subarray(20, 20 + length).toString()), rows, columns, pixels: payload.subarray(20 + length) };
  images++;
}));

// A hole in the plane of the probe, so that the sagittal picture shows the whole needle.
const { test } = stage({
  options: ['--set', 'insertion.hole="D3"'], prepare: listen, ready: async (set) => ({ page, problems } = set),
});

const newImage = async (what, good) => {
  const before = images;
  return until(what, () => image, (now) => images > before && now !== null && good(now));
};

/** The z [mm] at the end of the needle in a sagittal picture, found from its grey values alone. */
function tipInPicture({ rows, columns, pixels, first_mm, length_mm, depth_mm, origin_mm, right }) {
  const at = (line, sample) => pixels[line * columns + sample];
  const [near, far] = [6, 40].map((mm) => Math.round((mm / depth_mm) * (columns - 1)));
  // The needle is the depth with the brightest inferior third.
  let row = near;
  let most = 0;
  for (let sample = near; sample < far; sample++) {
    let sum = 0;
    for (let line = Math.round((2 * rows) / 3); line < rows; line++) sum += at(line, sample);
    if (sum > most) [row, most] = [sample, sum];
  }
  const reach = Math.ceil((1.2 / depth_mm) * (columns - 1));
  const profile = Array.from({ length: rows }, (_, line) => {
    let bright = 0;
    for (let sample = row - reach; sample <= row + reach; sample++) bright = Math.max(bright, at(line, sample));
    return bright;
  });
  const middle = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
  const threshold = (middle(profile.slice(-Math.floor(rows / 6))) + middle(profile.slice(0, Math.floor(rows / 4)))) / 2;
  let line = rows - 1;
  while (line > 2 && [0, 1, 2].some((k) => profile[line - k] > threshold)) line--;
  line++;
  const u = first_mm + (line / (rows - 1)) * length_mm;
  return { z: origin_mm[2] + u * right[2], fromProbe: (row / (columns - 1)) * depth_mm, line, row };
}

test('ultrasound is shown, and a click of the stepper moves it', async () => {
  await waitUntilReady(page);
  await until('the displacement field', () => status, (now) => now?.state === 'ready' && now.stage === '');
  assert.equal(images, 0, 'nobody has asked for a picture');
  await page.getByRole('button', { name: 'Ultrasound' }).click();
  const first = await newImage('a transverse picture', (now) => now.array === 'transverse');
  assert.ok(first.pixels.some((value) => value > 180), 'something is bright');
  await page.locator('#image canvas:visible').waitFor();
  const from = first.probe.depth_mm;
  await page.keyboard.press(']');
  const next = await newImage('the next plane', (now) => Math.abs(now.probe.depth_mm - from - now.probe.step_mm) < 1e-6);
  assert.notDeepEqual(next.pixels, first.pixels);
  await page.keyboard.press('[');
  await newImage('the plane before', (now) => Math.abs(now.probe.depth_mm - from) < 1e-6);
  await keepPicture(page, 'ultrasound-transverse');
});

test('the tip of the needle is found in the picture, and its depth is read to 1 mm', async () => {
  await page.keyboard.press('3');
  for (let k = 0; k < 13; k++) await page.keyboard.press('PageUp');
  await untilReadout(page, 'Depth', (depth) => depth > 61.9);
  await page.keyboard.press('s');
  await newImage('a sagittal picture', (now) => now.array === 'sagittal');
  await page.waitForTimeout(1500);  // the tissue creeps
  const shown = await newImage('the newest moment', () => true);
  const found = tipInPicture(shown);
  console.log(`the tip is at z = ${tip[2].toFixed(2)} mm; in the picture at ${found.z.toFixed(2)} mm`);
  assert.ok(Math.abs(found.z - tip[2]) < 1, `${found.z} mm in the picture, ${tip[2]} mm`);
  // Read at the same place with the pointer, as a clinician does: the picture's place on the screen follows from two
  // readings.
  const canvas = await page.locator('#image canvas:visible').boundingBox();
  const read = async (x, y) => {
    await page.mouse.move(canvas.x + x, canvas.y + y);
    const text = await until('a reading', () => page.locator('.pointer').textContent(), (t) => t.includes('from the probe'));
    const number = (pattern) => Number(pattern.exec(text)[1].replace('−', '-'));
    return { fromProbe: number(/^([\d.]+) mm from/), z: number(/z ([−\d.]+) mm/) };
  };
  const [x, y] = [canvas.width / 2, canvas.height / 2];
  const [here, there] = [await read(x - 40, y - 40), await read(x + 40, y + 40)];
  const toX = x - 40 + (80 * (found.z - here.z)) / (there.z - here.z);
  const toY = y - 40 + (80 * (found.fromProbe - here.fromProbe)) / (there.fromProbe - here.fromProbe);
  const reading = await read(toX, toY);
  assert.ok(Math.abs(reading.z - tip[2]) < 1, `${reading.z} mm read, ${tip[2]} mm`);
  await page.getByRole('button', { name: 'True position' }).click();
  await keepPicture(page, 'ultrasound-sagittal');
});

test('pictures come while the needle moves', async () => {
  const rates = [];
  for (let k = 0; k < 14; k++) {
    await page.keyboard.press(k % 2 === 0 ? 'PageDown' : 'PageUp');
    await page.waitForTimeout(500);
    const text = await page.locator('.picture-rate:visible').textContent();
    if (k > 2) rates.push(Number.parseInt(text, 10) || 0);
  }
  rates.sort((a, b) => a - b);
  console.log(`pictures per second, drawn in software: median ${rates[5]}, ${rates[0]} to ${rates[10]}`);
  assert.ok(rates[5] >= 1, 'pictures are drawn while the needle moves');
});

test('the picture follows the needle, and a frozen one does not', async () => {
  await page.keyboard.press('f');
  assert.equal(await page.getByRole('button', { name: /Freeze/ }).getAttribute('aria-pressed'), 'true');
  const canvas = page.locator('#image canvas:visible');
  await page.getByRole('button', { name: 'True position' }).click();
  await page.mouse.move(5, 5);
  // The rate lies over the picture, and counts down for a second.
  await until('the rate of pictures to rest', () => page.locator('.picture-rate').allTextContents(), (all) => all.join('') === '');
  let frozen = await canvas.screenshot();
  await until('marks that are drawn', () => canvas.screenshot(), (now) => {
    const same = now.equals(frozen);
    frozen = now;
    return same;
  });
  for (let k = 0; k < 3; k++) await page.keyboard.press('PageDown');
  await untilReadout(page, 'Depth', (depth) => depth < 47.1);
  assert.deepEqual(await canvas.screenshot(), frozen);
  await page.keyboard.press('f');
  await until('another picture', () => canvas.screenshot(), (now) => !now.equals(frozen));
});

test('the C-arm turns, and the 3D view comes back', async () => {
  await page.getByRole('button', { name: 'X-ray' }).click();
  await newImage('an X-ray picture', (now) => now.modality === 'xray');
  await keepPicture(page, 'xray');
  const slider = page.locator('.knob', { hasText: 'Angle' }).locator('input');
  await slider.fill('35');
  await newImage('another angle', (now) => now.angle_deg === 35);
  await keepPicture(page, 'xray-35');
  await page.getByRole('button', { name: '3D', exact: true }).click();
  await page.locator('#view3d').waitFor();
  await until('no more pictures', () => status, (now) => now.image.shown === 'none');
});

test('a recording is looked at with another place of the probe', async () => {
  await page.waitForTimeout(1000);  // recordings are written to the disk five times a second
  await page.getByRole('button', { name: 'Recordings' }).click();
  await page.getByRole('button', { name: 'Replay' }).first().click();
  await page.locator('#replay').waitFor();
  await page.getByRole('button', { name: 'Ultrasound' }).click();
  const from = await newImage('a picture of the recording', (now) => now.modality === 'ultrasound');
  await page.keyboard.press(']');
  await newImage('another plane', (now) => Math.abs(now.probe.depth_mm - from.probe.depth_mm - from.probe.step_mm) < 1e-6);
  await page.getByRole('button', { name: 'Back to the live needle' }).click();
  await until('the live needle', () => status, (now) => now.mode === 'live');
  assert.ok((await readout(page, 'Depth')) < 50);
  assert.deepEqual(problems, []);
});
