// SPDX-License-Identifier: GPL-3.0-or-later
// Buttons for speed, pause, single steps, reset, bevel and tilt.
import { button, element } from '../../../shared/dom';
import { SPEEDS, type HandControl } from '../hand';
import type { Session } from '../session';
import { reset, togglePause } from './keyboard';

export class Steering {
  private readonly pause: HTMLButtonElement;
  private readonly all: HTMLButtonElement[] = [];
  private readonly pose = element('output', 'pose');
  private readonly step: HTMLButtonElement;

  constructor(root: HTMLElement, private readonly session: Session, private readonly hand: HandControl) {
    const make = (text: string, title: string, action: () => void) => {
      const b = button(text, action);
      b.title = title;
      this.all.push(b);
      return b;
    };
    const speeds = element('div', 'row speeds');
    speeds.setAttribute('role', 'group');
    speeds.setAttribute('aria-label', 'Speed of the needle');
    speeds.append(element('span', 'name', 'Speed'));
    const presets = SPEEDS.map((speed, i) => {
      const b = make(String(speed), `${speed} mm/s (key ${i + 1})`, () => hand.setSpeed(speed));
      speeds.append(b);
      return b;
    });
    speeds.append(element('span', 'unit', 'mm/s'));
    hand.onChange(() => {
      presets.forEach((b, i) => b.setAttribute('aria-pressed', String(hand.target.speed === SPEEDS[i])));
      this.writePose();
    });
    this.pause = make('Pause', 'Pause or resume (Space)', () => togglePause(session));
    this.step = make('Step', 'Make a single step while paused (.)', () => session.command({ do: 'step', count: 1 }));
    const again = make('Start again', 'Go back to the start of this insertion (R)', () => reset(session, hand));
    const run = element('div', 'row');
    run.append(this.pause, this.step, again);
    const turn = element('div', 'row pad');
    turn.append(
      make('⟲', 'Turn the bevel (Q)', () => hand.roll(-15)), make('⟳', 'Turn the bevel (E)', () => hand.roll(15)),
      make('←', 'Tilt the hub to the patient’s right (A)', () => hand.tilt(-0.5, 0)),
      make('→', 'Tilt the hub to the patient’s left (D)', () => hand.tilt(0.5, 0)),
      make('↑', 'Tilt the hub to anterior (Shift ↑)', () => hand.tilt(0, 0.5)),
      make('↓', 'Tilt the hub to posterior (Shift ↓)', () => hand.tilt(0, -0.5)));
    for (const b of turn.querySelectorAll('button')) b.setAttribute('aria-label', b.title);
    root.append(speeds, run, turn, this.pose);
    session.on('status', () => this.update());
    session.on('link', () => this.update());
    session.on('frame', () => this.hand.target.roll === 0 || this.writePose());
    hand.setSpeed(SPEEDS[1]);
    this.update();
  }

  private update(): void {
    const { status, steering, connected } = this.session;
    const replaying = connected && status?.mode === 'replay' && status.you_hold === true;
    for (const b of this.all) b.disabled = !steering;
    this.pause.disabled = !steering && !replaying;
    const paused = status?.mode === 'replay' ? !status.replay?.playing : status?.paused === true;
    this.pause.textContent = paused ? 'Resume' : 'Pause';
    this.step.disabled = !steering || !paused;
  }

  private writePose(): void {
    const { roll, tiltLeft, tiltAnterior } = this.hand.target;
    const text = `Bevel ${roll.toFixed(0)}°, hub ${tilt(tiltLeft, 'left', 'right')}, ${tilt(tiltAnterior, 'anterior', 'posterior')}`;
    if (this.pose.textContent !== text) this.pose.textContent = text;
  }
}

function tilt(degrees: number, positive: string, negative: string): string {
  return `${Math.abs(degrees).toFixed(1)}° ${degrees >= 0 ? positive : negative}`;
}
