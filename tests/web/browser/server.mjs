// SPDX-License-Identifier: GPL-3.0-or-later
// Starts stylet serve as a user does.
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const REPOSITORY = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../../..');
export const DEMO = path.join(REPOSITORY, 'scenarios/demo.toml');
/** A coarse mesh that is ready soon, for tests that do not depend on the mesh. */
export const SMALL = ['--set', 'mesh.nodes=800'];

export function makeFolder() {
  const folder = mkdtempSync(path.join(tmpdir(), 'stylet-page-'));
  return { folder, remove: () => rmSync(folder, { recursive: true, force: true }) };
}

/**
 * @param folder folder for the recordings and for cached models
 * @param options arguments after the scenario; the port is a free one unless they name another
 * @returns url, port, memory() of the process [bytes], kill(signal)
 */
export async function startServer(folder, { scenario = DEMO, options = [], port = 0 } = {}) {
  const program = process.env.STYLET ?? path.join(REPOSITORY, 'build/bin/stylet');
  const server = spawn(program, ['serve', scenario, '--port', String(port), '--json', '-', '-o', path.join(folder, 'live'), ...options],
    { env: { ...process.env, XDG_CACHE_HOME: path.join(folder, 'cache') } });
  const ended = new Promise((resolve) => server.once('exit', resolve));
  let said = '';
  let complaint = '';
  server.stderr.on('data', (text) => (complaint += text));
  const address = await new Promise((resolve, reject) => {
    server.once('error', reject);
    server.once('exit', (code) => reject(new Error(`stylet serve ended with ${code} before it listened: ${complaint}`)));
    server.stdout.on('data', (text) => {
      said += text;
      if (said.trimEnd().endsWith('}')) resolve(JSON.parse(said));
    });
  });
  return {
    url: address.url,
    port: address.port,
    memory: () => 1024 * Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${server.pid}/status`, 'utf8'))[1]),
    async kill(signal = 'SIGTERM') {
      server.kill(signal);
      await ended;
    },
  };
}
