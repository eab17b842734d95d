// SPDX-License-Identifier: GPL-3.0-or-later
// Seeks to a moment of a recording. The command is repeated until the server shows the moment, because a command may be
// lost, and then the slider would show another time than the picture.
import type { Session } from '../session';

const MOST_OFTEN_MS = 50;      // least time between commands while a slider is dragged
const AGAIN_MS = 100;          // wait before the first repeat; it doubles each time
const SELDOM_MS = 1000;
const NEAR_S = 1e-3;
const PICTURE_S = 0.05;        // a playing replay advances at most this much before its next picture

export class Seek {
  private wanted: number | null = null;  // [s] wanted time
  private of = '';             // name of the recording
  private wantedSince = 0;
  private askedAt = -Infinity;
  private wait = AGAIN_MS;
  private timer = 0;

  constructor(private readonly session: Session) {
    session.on('status', (status) => {
      if (this.wanted === null || status.state !== 'ready') return;
      const replay = status.mode === 'replay' ? status.replay : null;
      const taken = status.held === true && !status.you_hold;  // another viewer controls the replay
      if (!replay || replay.name !== this.of || taken) this.end();
      else this.see(replay.time_s);
    });
    session.on('frame', (frame) => frame.replayed && this.see(frame.time));
  }

  /** Whether the wanted time has not been shown yet. */
  get pending(): boolean {
    return this.wanted !== null;
  }

  to(time_s: number): void {
    const replay = this.session.status?.replay;
    if (!replay || this.wanted === time_s) return;
    const now = performance.now();
    this.wanted = time_s;
    this.of = replay.name;
    this.wantedSince = now;
    this.wait = AGAIN_MS;
    this.askIn(Math.max(0, this.askedAt + MOST_OFTEN_MS - now));
  }

  private askIn(ms: number): void {
    clearTimeout(this.timer);
    if (ms === 0) this.ask();
    else this.timer = window.setTimeout(() => this.ask(), ms);
  }

  private ask(): void {
    if (this.wanted === null) return;
    const { connected, status } = this.session;
    if (connected && status?.state === 'ready' && status.you_hold) {
      this.askedAt = performance.now();
      this.session.command({ do: 'seek', time_s: this.wanted });
    }
    if (this.wanted === null) return;  // the answer came at once
    this.askIn(this.wait);
    this.wait = Math.min(2 * this.wait, SELDOM_MS);
  }

  private see(time_s: number): void {
    const replay = this.session.status?.replay;
    if (this.wanted === null || !replay) return;
    const there = Math.max(0, Math.min(this.wanted, replay.duration_s));
    const since_s = (performance.now() - this.wantedSince) / 1000;
    const gone = replay.playing ? replay.rate * (since_s + PICTURE_S) : 0;  // it has advanced since
    if (time_s > there - NEAR_S && time_s < there + NEAR_S + gone) this.end();
  }

  private end(): void {
    this.wanted = null;
    clearTimeout(this.timer);
  }
}
