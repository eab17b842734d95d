// SPDX-License-Identifier: GPL-3.0-or-later
// Replaying a recording: time, rate, and back to the live needle. Takes the push bar's place.
import { button, element } from '../../../shared/dom';
import { serverAddress } from '../connection';
import type { Session } from '../session';
import { togglePause } from './keyboard';

const RATES = [0.1, 0.25, 0.5, 1, 2, 4];

export class ReplayBar {
  private readonly title = element('b');
  private readonly play: HTMLButtonElement;
  private readonly slider = element('input');
  private readonly text = element('output');
  private readonly rate = element('select');
  private readonly curve = element('a', '', 'CSV');
  private readonly back: HTMLButtonElement;
  private dragging = false;
  private askedAt = 0;

  constructor(private readonly root: HTMLElement, private readonly push: HTMLElement, private readonly session: Session) {
    this.play = button('Pause', () => togglePause(session));
    this.back = button('Back to the live needle', () => session.command({ do: 'live' }));
    this.slider.type = 'range';
    this.slider.min = '0';
    this.slider.step = 'any';
    this.slider.setAttribute('aria-label', 'Time of the recording');
    this.slider.addEventListener('input', () => {
      this.dragging = true;
      this.write(this.slider.valueAsNumber);
      if (performance.now() - this.askedAt > 50) this.seek();
    });
    this.slider.addEventListener('change', () => {
      this.seek();
      this.dragging = false;
    });
    this.rate.setAttribute('aria-label', 'Speed of the replay');
    for (const rate of RATES) this.rate.append(new Option(`× ${rate}`, String(rate)));
    this.rate.value = '1';
    this.rate.addEventListener('change', () => session.command({ do: 'play', rate: Number(this.rate.value) }));
    this.curve.title = 'Force curve of this recording';
    root.append(this.title, this.play, this.slider, this.text, this.rate, this.curve, this.back);
    session.on('status', () => this.update());
    session.on('frame', (frame) => {
      if (frame.replayed && !this.dragging) this.write(frame.time);
    });
  }

  private seek(): void {
    this.askedAt = performance.now();
    this.session.command({ do: 'seek', time_s: this.slider.valueAsNumber });
  }

  private update(): void {
    const { status } = this.session;
    const replay = status?.mode === 'replay' ? status.replay : null;
    this.root.hidden = !replay;
    this.push.hidden = !!replay;
    if (!replay) return;
    this.title.textContent = `Replay of ${replay.name}`;
    this.slider.max = String(replay.duration_s);
    if (!this.dragging) this.write(replay.time_s);
    this.play.textContent = replay.playing ? 'Pause' : 'Play';
    if (replay.rate > 0 && document.activeElement !== this.rate) this.rate.value = String(replay.rate);
    this.curve.href = serverAddress(`recordings/${encodeURIComponent(replay.name)}/forces.csv`);
    this.curve.download = `${replay.name}-forces.csv`;
    for (const control of [this.play, this.slider, this.rate, this.back]) control.disabled = status?.you_hold !== true;
  }

  private write(time: number): void {
    if (!this.dragging) this.slider.value = String(time);
    this.text.textContent = `${time.toFixed(2)} of ${Number(this.slider.max).toFixed(1)} s`;
  }
}
