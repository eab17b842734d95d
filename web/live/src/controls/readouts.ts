// SPDX-License-Identifier: GPL-3.0-or-later
// Current values: depth, speed, tip, forces; the key figures of the insertion; and, folded, the work of the computer.
import { element } from '../../../shared/dom';
import { CURVES } from '../../../shared/plot_style';
import { onRepaintEvery } from '../../../shared/repaint';
import type { Session } from '../session';
import { SAMPLE_WORDS, TIP_STATES, type Frame } from '../wire';
import { ComputerDetails, computerFacts } from './computer_details';
import { KeyFigures } from './key_figures';

const WRITE_EVERY_MS = 100;

class Value {
  readonly row = element('div', 'value');
  private readonly text = element('b', '', '–');
  private readonly unit: HTMLElement;

  constructor(label: string, unit: string, color = '') {
    const name = element('span', 'name', label);
    if (color) name.style.setProperty('--curve', color);
    if (color) name.classList.add('curve');
    this.unit = element('span', 'unit', unit);
    this.row.append(name, this.text, this.unit);
  }

  set(text: string): void {
    if (this.text.textContent !== text) this.text.textContent = text;
  }
}

export class Readouts {
  private readonly depth = new Value('Depth', 'mm');
  private readonly speed = new Value('Speed', 'mm/s');
  private readonly tip = new Value('Tip', '');
  private readonly forces = CURVES.map((c) => new Value(c.label, 'N', c.color));
  private readonly warning = element('p', 'warning');
  private readonly computer = new ComputerDetails();

  constructor(root: HTMLElement, private readonly session: Session) {
    this.depth.row.classList.add('large');
    this.depth.row.title = 'Depth beyond the skin at which the tip of a straight needle on the same base would be';
    this.forces[0].row.classList.add('large');
    this.warning.hidden = true;
    const figures = element('div', 'figures');
    new KeyFigures(figures, session);
    root.append(this.depth.row, this.forces[0].row, this.forces[1].row, this.forces[2].row, this.speed.row, this.tip.row,
                figures, this.warning, this.computer.box);
    const write = onRepaintEvery(WRITE_EVERY_MS, () => this.write());
    for (const topic of ['frame', 'status', 'link'] as const) session.on(topic, write);
  }

  private write(): void {
    const { frame, status } = this.session;
    if (frame) {
      this.depth.set(frame.depth.toFixed(1).replace('-', '−'));
      this.speed.set(frame.paused ? 'paused' : speedOf(frame).toFixed(0));
      this.tip.set(TIP_STATES[frame.tipState] ?? `state ${frame.tipState}`);
      this.forces.forEach((value, k) => value.set(signed(frame.force[k])));
      this.warn(!frame.trusted ? 'Do not trust these forces: the step did not converge.'
                : frame.unfelt ? 'No force: the needle is in tissue without any contact. Draw the needle out.'
                : frame.approximate && TIP_STATES[frame.tipState] === 'in air' ? 'No force yet: the tissue here is not ready. Wait at the skin, or draw the needle out.'
                : frame.approximate ? 'Forces are approximate: the needle is in tissue that is not yet precomputed.' : '', !frame.trusted);
    }
    this.computer.write(computerFacts(frame, status));
  }

  private warn(text: string, serious: boolean): void {
    if (this.warning.textContent !== text) this.warning.textContent = text;
    this.warning.hidden = text === '';
    this.warning.classList.toggle('serious', serious);
  }
}

/** Speed of the base over the steps of a frame [mm/s]. */
function speedOf({ samples }: Frame): number {
  const last = samples.length - SAMPLE_WORDS;
  const time = last > 0 ? samples[last] - samples[0] : 0;
  return time > 0 ? Math.abs(samples[last + 1] - samples[1]) / time : 0;
}

function signed(value: number): string {
  const text = value.toFixed(2);
  return text === '-0.00' ? '0.00' : text.replace('-', '−');
}
