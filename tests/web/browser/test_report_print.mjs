// SPDX-License-Identifier: GPL-3.0-or-later
// The reports of doses and implants on paper: printed as A4 by the browser, no text leaves a page or covers other text.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
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

/** What is wrong with the text of pages, in words. */
export function faultsOf(pages) {
  return pages.flatMap(({ width, height, words }, page) => [
    ...words.filter((w) => w.x0 < EDGE_PT || w.y0 < EDGE_PT || w.x1 > width - EDGE_PT || w.y1 > height - EDGE_PT)
      .map((w) => `page ${page + 1}: "${w.text}" leaves the page`),
    ...words.flatMap((a, k) => words.slice(k + 1).filter((b) => overlap(a, b)).map((b) => `page ${page + 1}: "${a.text}" covers "${b.text}"`)),
  ]);
}

async function print(report, name, width = 1366) {
  const { page, problems } = await openVisitor(browser, pathToFileURL(report).href, { width });
  const pdf = path.join(folder, `${name}.pdf`);
  await page.pdf({ path: pdf, preferCSSPageSize: true, printBackground: true });
  await page.close();
  assert.deepEqual(problems, []);
  if (process.env.STYLET_SCREENSHOTS) writeFileSync(path.join(process.env.STYLET_SCREENSHOTS, `${name}.pdf`), readFileSync(pdf));
  return pagesOf(pdf);
}

function checkPaper(pages, wanted) {
  assert.deepEqual(faultsOf(pages), []);
  pages.forEach(({ width, height, words }, page) => {
    assert.ok(Math.abs(width - 595) < 1.5 && Math.abs(height - 842) < 1.5, `page ${page + 1} is ${width} × ${height} pt, not A4`);
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

const REPORTS = (process.env.STYLET_REPORTS ?? '').split(',').filter(Boolean);
for (const entry of REPORTS) {
  const [name, program] = entry.split('=');
  test(`the ${name} report fits on A4`, async () => {
    const out = path.join(folder, name);
    const made = spawnSync(program, [out], { encoding: 'utf8' });
    assert.equal(made.status, 0, made.stderr);
    const report = readdirSync(out).includes('report.html') ? path.join(out, 'report.html') : out;
    checkPaper(await print(report, name), [/Goals/, /Checked by/, /SHA-256|Program/, /No\./]);
  });
}
