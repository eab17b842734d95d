// SPDX-License-Identifier: GPL-3.0-or-later
// Runs test_*.mjs of this folder with Node's test runner, each bundled with the TypeScript that it tests.
//   node run.mjs WEB_BUILD_FOLDER FOLDER_FOR_BUNDLES
import { spawnSync } from 'node:child_process';
import { mkdirSync, readdirSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const [web, bundles] = process.argv.slice(2).map((p) => path.resolve(p));
const here = path.dirname(fileURLToPath(import.meta.url));
const esbuild = createRequire(path.join(web, 'package.json'))('esbuild');
const tests = readdirSync(here).filter((name) => /^test_.*\.mjs$/.test(name));
rmSync(bundles, { recursive: true, force: true });
mkdirSync(bundles, { recursive: true });
esbuild.buildSync({
  entryPoints: tests.map((name) => path.join(here, name)),
  outdir: bundles, outExtension: { '.js': '.mjs' }, bundle: true, platform: 'node', format: 'esm', target: 'node18', sourcemap: 'inline',
  alias: { live: path.join(web, 'live'), report: path.join(web, 'report'), shared: path.join(web, 'shared') }, logLevel: 'error',
});
const run = spawnSync(process.execPath, ['--enable-source-maps', '--test', ...tests.map((name) => path.join(bundles, name))], { stdio: 'inherit' });
process.exit(run.status ?? 1);
