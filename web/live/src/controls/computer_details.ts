// SPDX-License-Identifier: GPL-3.0-or-later
// How the computer keeps up with the needle, for those who look after it: a part that is folded until it is asked for.
import { element } from '../../../shared/dom';
import type { Frame, Status } from '../wire';

/** The lines of the part. */
export function computerFacts(frame: Frame | null, status: Status | null): string[] {
  if (frame?.replayed) return ['A recording is shown; nothing is computed.'];
  const loop = status?.loop;
  const steps = frame?.steps ?? loop?.steps ?? 0;
  const missed = frame?.missed ?? loop?.missed ?? 0;
  if (steps === 0) return ['No step has been computed yet.'];
  const count = (value: number) => value.toLocaleString('en');
  const late = missed === 0 ? `All ${count(steps)} steps were on time.` : `${count(missed)} of ${count(steps)} steps were late.`;
  if (!loop || loop.steps === 0) return [late];
  const us = (value: number) => `${value.toFixed(0)} µs`;
  return [late, `A step takes ${us(loop.p50_us)}; 99 % take at most ${us(loop.p99_us)}, the slowest took ${us(loop.max_us)}.`, loop.rights ? `It runs with ${loop.rights}.` : ''].filter(Boolean);
}

export class ComputerDetails {
  readonly box = element('details', 'computer');
  private readonly lines = element('div');
  private written = '';

  constructor() {
    this.box.append(element('summary', '', 'Computer'), this.lines);
    this.box.title = 'How the computer keeps up with the needle';
  }

  write(lines: string[]): void {
    const text = lines.join('\n');
    if (text === this.written) return;
    this.written = text;
    this.lines.replaceChildren(...lines.map((line) => element('p', '', line)));
  }
}
