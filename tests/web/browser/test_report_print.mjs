// SPDX-License-Identifier: GPL-3.0-or-later
// The reports of doses and implants on paper: printed as A4 by the browser, no text leaves a page or covers other text.
// On the screen, their charts tell what the pointer is at.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { openBrowser, openVisitor, skipWithoutChromium } from './browser.mjs';

skipWithoutChromium();
const SKIPPED = 77;
if (spawnSync('pdftotext', ['-v']).error) {
  console.log('Skipped: no pdftotext. Install the package poppler-utils.');
  process.exit(SKIPPED);
}
const EDGE_PT = 8;  // no printer reaches further to the edge of the paper

const folder = mkdtempSync(path.join(tmpdir(), 'stylet-print-'));
let browser;
before(async () => (browser = await openBrowser({ webgl: false })));
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** The words of each page of a PDF with their boxes [pt], and the size of the page. */
function pagesOf(pdf) {
  const { stdout, status } = spawnSync('pdftotext', ['-bbox', pdf, '-'], { encoding: 'utf8', maxBuffer: 1e8 });
  assert.equal(status, 0);
  return stdout.split('<page ').slice(1).map((page) => {
    const [width, height] = /width="([\d.]+)" height="([\d.]+)"/.exec(page).slice(1).map(Number);
    const words = [...page.matchAll(/<word xMin="(\S+)" yMin="(\S+)" xMax="(\S+)" yMax="(\S+)">(.*)<\/word>/g)]
      .map(([, x0, y0, x1, y1, text]) => ({ x0: +x0, y0: +y0, x1: +x1, y1: +y1, text }));
    return { width, height, words };
  });
}

const overlap = (a, b) => {
  const wide = Math.min(a.x1, b.x1) - Math.max(a.x0, b.x0);
  const high = Math.min(a.y1, b.y1) - Math.max(a.y0, b.y0);
  // boxes are as high as the lines, so neighbouring lines touch; letters overlap where much of both is shared
  return wide > 1.5 && high > 0.4 * Math.min(a.y1 - a.y0, b.y1 - b.y0);
};

// a text with a rim is drawn twice at the same place, with boxes of different height
const near = (a, b) => Math.abs(a - b) < 0.5;
const isRimOf = (a, b) => a.text === b.text && near(a.x0, b.x0) && near(a.x1, b.x1) && near(a.y0 + a.y1, b.y0 + b.y1);

/** The faults of the pages' text, in words. */
function faultsOf(pages) {
  return pages.flatMap(({ width, height, words }, page) => [
    ...words.filter((w) => w.x0 < EDGE_PT || w.y0 < EDGE_PT || w.x1 > width - EDGE_PT || w.y1 > height - EDGE_PT)
      .map((w) => `page ${page + 1}: "${w.text}" leaves the page`),
    ...words.flatMap((a, k) => words.slice(k + 1).filter((b) => overlap(a, b) && !isRimOf(a, b))
      .map((b) => `page ${page + 1}: "${a.text}" covers "${b.text}"`)),
  ]);
}

async function print(report, name, width = 1366) {
  const { page, problems } = await openVisitor(browser, pathToFileURL(report).href, { width });
  const pdf = path.join(folder, `${name}.pdf`);
  await page.pdf({ path: pdf, preferCSSPageSize: true, printBackground: true });
  await page.close();
  assert.deepEqual(problems, []);
  if (process.env.STYLET_SCREENSHOTS)
    copyFileSync(pdf, path.join(process.env.STYLET_SCREENSHOTS, `${name}.pdf`));
  return pagesOf(pdf);
}

function checkPaper(pages, wanted) {
  assert.deepEqual(faultsOf(pages), []);
  pages.forEach(({ width, height, words }, page) => {
    const isA4 = Math.abs(width - 595) < 1.5 && Math.abs(height - 842) < 1.5;
    assert.ok(isA4, `page ${page + 1} is ${width} × ${height} pt, not A4`);
    const text = words.map((w) => w.text).join(' ');
    for (const part of ['Patient ID', 'Computed on', 'not a medical device', `Page ${page + 1} of ${pages.length}`]) {
      assert.ok(text.includes(part), `page ${page + 1} says "${part}"`);
    }
    assert.ok(words.length > 30, `page ${page + 1} is not empty`);
    assert.doesNotMatch(text, /(^| )-\d/, 'numbers have minus signs');
  });
  const all = pages.flatMap(({ words }) => words.map((w) => w.text)).join(' ');
  for (const part of wanted) assert.match(all, part);
}

test('boxes that overlap or leave the page are found', () => {
  const box = (x0, y0, text) => ({ x0, y0, x1: x0 + 40, y1: y0 + 10, text });
  const page = (...words) => [{ width: 595, height: 842, words }];
  assert.equal(faultsOf(page(box(50, 50, 'a'), box(60, 52, 'b'))).length, 1);
  assert.equal(faultsOf(page(box(570, 50, 'a'))).length, 1);
  assert.equal(faultsOf(page(box(50, 50, 'a'), box(50, 60, 'b'), box(91, 50, 'c'))).length, 0);
});

/** Runs the program in the test's folder. */
function stylet(...parameters) {
  const { status, stderr } = spawnSync(process.env.STYLET, parameters, { cwd: folder, encoding: 'utf8' });
  assert.equal(status, 0, stderr);
}

const SCENARIO = `
name = "Two needles"
[patient]
source = "case/phantom.dcm"
[fixed]
outer = "sides"
[mesh]
nodes = 1000
[plan]
file = "two.csv"
[procedure]
speed_mm_per_s = 60
pause_s = 0.5
drop_speed_mm_per_s = 20
retract_speed_mm_per_s = 60
[run]
dt_ms = 8
`;
const TWO_NEEDLES = `# source: i125_6711
# strength_U: 0.5
# prescription_Gy: 145
# template_origin_mm: 0.0 0.2 20.0
hole,retraction_mm,train
C4,5,S-1-S-1-S
E4,10,S-1-S
`;
const WHOLE_PLAN = fileURLToPath(new URL('../../../scenarios/demo_plan.csv', import.meta.url));

test('the report of a plan that is compared with a dose grid fits on A4', async () => {
  stylet('phantom', '-o', 'case');
  const plan = ['dose', WHOLE_PLAN, '--structures', 'case/phantom.dcm'];
  stylet(...plan, '-o', 'first');
  stylet(...plan, '--compare', 'first/dose.dcm', '--compare-shift', '1', '0', '0', '-o', 'dose');
  const pages = await print(path.join(folder, 'dose/report.html'), 'dose');
  checkPaper(pages, [/Goals/, /Volume \[%\]/, /Gamma index/, /Computed dose minus the dose of the file/, /SHA-256/, /Checked by/]);
});

test('the report of an implant fits on A4', async () => {
  writeFileSync(path.join(folder, 'two.toml'), SCENARIO);
  writeFileSync(path.join(folder, 'two.csv'), TWO_NEEDLES);
  stylet('implant', 'two.toml', '-o', 'implant');
  const pages = await print(path.join(folder, 'implant/report.html'), 'implant');
  checkPaper(pages, [/Goals/, /Volume \[%\]/, /Why/, /Mean error \[mm\]/, /Error \[mm\]/, /SHA-256/, /Checked by/]);
});

/** What a chart tells at the first place from its upper left corner at which it tells anything. */
const told = (plot) => plot.evaluate((box) => {
  const over = box.querySelector('.u-over');
  const { left, top, width, height } = over.getBoundingClientRect();
  for (let y = 10; y < height; y += 10) {
    for (let x = 10; x < width; x += 10) {
      over.dispatchEvent(new MouseEvent('mousemove', { clientX: left + x, clientY: top + y }));
      const readout = box.querySelector('.readout');
      if (!readout.hidden) return readout.textContent;
    }
  }
  return 'nothing';
});

test('the charts of an implant fit into narrow windows and tell the values at the pointer', async () => {
  const report = pathToFileURL(path.join(folder, 'implant/report.html')).href;
  for (const width of [390, 1366]) {
    const { page, problems } = await openVisitor(browser, report, { width });
    const plots = await page.locator('.plot').all();
    assert.equal(plots.length, 4, 'histograms and the errors along three axes');
    for (const plot of plots) {
      const { x, width: wide } = await plot.locator('canvas').boundingBox();
      assert.ok(x >= 0 && x + wide <= width, `a chart reaches from ${x} to ${x + wide} px`);
    }
    assert.match(await told(plots[0]), /^[\d.]+ Gy = \d+ %.*, delivered: [\d.]+ %.*, planned: [\d.]+ %/);
    assert.match(await told(plots[3]), /^Seed \d, needle [CE]4[\d.]+ mm to (superior|inferior)$/);
    const bars = await page.locator('#cause-chart .track').allTextContents();
    assert.ok(bars.length >= 8 && bars.every((text) => /^[+−]?\d+\.\d\d$/.test(text)), bars.join(' '));
    assert.deepEqual(problems, []);
    await page.close();
  }
});

test('no report is wider than a telephone', async () => {
  const insertion = '[[insertion]]\nhole = "C4"\ndepth_mm = 40\nspeed_mm_per_s = 60\nretract_speed_mm_per_s = 60\n';
  writeFileSync(path.join(folder, 'one.toml'), SCENARIO.replace(/\[plan\][^]*(?=\[run\])/, insertion));
  stylet('insert', 'one.toml', '-o', 'insertion', '--set', 'output.pictures=false');
  for (const report of ['insertion', 'implant', 'dose']) {
    const { page } = await openVisitor(browser, pathToFileURL(path.join(folder, report, 'report.html')).href, { width: 390 });
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390, report);
    await page.close();
  }
});
