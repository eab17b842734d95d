// SPDX-License-Identifier: GPL-3.0-or-later
// Controls of a replay: time, rate, and the way back to the live needle. It replaces the push bar.
import { button, element } from '../../../shared/dom';
import { serverAddress } from '../connection';
import type { Session } from '../session';
import { togglePause } from './keyboard';
import { Seek } from './seek';

const RATES = [0.1, 0.25, 0.5, 1, 2, 4];

export class ReplayBar {
  private readonly title = element('b');
  private readonly play: HTMLButtonElement;
  private readonly slider = element('input');
  private readonly text = element('output');
  private readonly rate = element('select');
  private readonly curve = element('a', '', 'CSV');
  private readonly back: HTMLButtonElement;
  private readonly seek: Seek;
  private dragging = false;

  constructor(private readonly root: HTMLElement, private readonly push: HTMLElement, private readonly session: Session) {
    this.seek = new Seek(session);
    this.play = button('Pause', () => togglePause(session));
    this.back = button('Back to the live needle', () => session.command({ do: 'live' }));
    this.slider.type = 'range';
    this.slider.min = '0';
    this.slider.step = 'any';
    this.slider.setAttribute('aria-label', 'Time of the recording');
    this.slider.addEventListener('input', () => {
      this.dragging = true;
      this.writeText(this.slider.valueAsNumber);
      this.seek.to(this.slider.valueAsNumber);
    });
    this.slider.addEventListener('change', () => {
      this.dragging = true;
      this.letGo();
    });
    this.slider.addEventListener('blur', () => this.letGo());
    for (const end of ['pointerup', 'pointercancel']) window.addEventListener(end, () => this.letGo());
    this.rate.setAttribute('aria-label', 'Speed of the replay');
    for (const rate of RATES) this.rate.append(new Option(`× ${rate}`, String(rate)));
    this.rate.value = '1';
    this.rate.addEventListener('change', () => session.command({ do: 'play', rate: Number(this.rate.value) }));
    this.curve.title = 'Force curve of this recording';
    root.append(this.title, this.play, this.slider, this.text, this.rate, this.curve, this.back);
    session.on('status', () => this.update());
    session.on('link', () => {
      if (!session.connected) this.dragging = false;  // the slider cannot be dragged then
      this.update();
    });
    session.on('frame', (frame) => {
      if (frame.replayed) this.write(frame.time);
    });
  }

  private letGo(): void {
    if (!this.dragging) return;
    this.dragging = false;
    this.seek.to(this.slider.valueAsNumber);
  }

  private update(): void {
    const { status, connected } = this.session;
    const replay = status?.mode === 'replay' ? status.replay : null;
    this.root.hidden = !replay;
    this.push.hidden = !!replay;
    if (!replay) return;
    this.title.textContent = `Replay of ${replay.name}`;
    this.slider.max = String(replay.duration_s);
    this.write(replay.time_s);
    this.play.textContent = replay.playing ? 'Pause' : 'Play';
    if (replay.rate > 0 && document.activeElement !== this.rate) this.rate.value = String(replay.rate);
    this.curve.href = serverAddress(`recordings/${encodeURIComponent(replay.name)}/forces.csv`);
    this.curve.download = `${replay.name}-forces.csv`;
    for (const control of [this.play, this.slider, this.rate, this.back]) control.disabled = !connected || status?.you_hold !== true;
  }

  /** Shows the time of the replay; while the user seeks, shows the wanted time. */
  private write(time: number): void {
    if (this.dragging || this.seek.pending) return;
    this.slider.value = String(time);
    this.writeText(time);
  }

  private writeText(time: number): void {
    this.text.textContent = `${time.toFixed(2)} of ${Number(this.slider.max).toFixed(1)} s`;
  }
}
