// SPDX-License-Identifier: GPL-3.0-or-later
// Where the hand wants the needle. Follows the simulation until somebody pushes, and after a jump (reset, another hole) again.
import { samePatient, type Scene } from './scene';
import type { Session } from './session';
import type { Hand } from './wire';

export const SPEEDS = [5, 20, 50];         // [mm/s]
const MOST_LEAD_S = 0.25;                  // a key that is held runs ahead of the needle by no more than this
const STOP_WITHIN_S = 0.08;                // a frame's age and the way there
const SEND_EVERY_MS = 1000 / 60;

export class HandControl {
  readonly target: Hand = { depth: 0, speed: 20, roll: 0, tiltLeft: 0, tiltAnterior: 0 };
  private active = false;
  private changed = false;
  private sentAt = 0;
  private timer = 0;
  private toldAt = 0;            // [ms] that the needle cannot be pushed now
  private readonly listeners: (() => void)[] = [];

  constructor(private readonly session: Session) {
    session.on('frame', () => this.active || this.follow());
    session.on('restart', () => this.rest());
    session.on('event', (e) => e.kind === 'started' && this.rest());
    session.on('status', () => session.steering || this.rest());
    let known: Scene | null = null;
    session.on('scene', (scene) => {
      const again = known !== null && samePatient(known, scene);
      known = scene;
      if (!again && scene.insertions.length > 0) this.setSpeed(nearest(SPEEDS, scene.insertions[0].speed_mm_per_s));
    });
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  /** The needle jumps: what the hand wanted before counts no longer. */
  rest(): void {
    this.active = false;
    this.changed = false;
  }

  setSpeed(speed: number): void {
    this.target.speed = speed;
    this.tell();
  }

  setDepth(depth: number): void {
    if (!this.begin()) return;
    const limits = this.session.scene?.limits;
    this.target.depth = limits ? clamp(depth, -limits.behind_mm, limits.depth_mm) : depth;
    this.send();
  }

  /** Pushes [mm], pulls when negative. */
  push(mm: number): void {
    if (this.begin()) this.setDepth(this.target.depth + mm);
  }

  /** Pushes as long as a key is held. @param direction −1 … 1 @param seconds since the last call */
  hold(direction: number, seconds: number): void {
    const frame = this.session.frame;
    if (!this.begin() || !frame) return;
    const lead = this.target.speed * MOST_LEAD_S;
    const wanted = this.target.depth + direction * this.target.speed * seconds;
    this.setDepth(direction > 0 ? Math.max(this.target.depth, Math.min(wanted, frame.depth + lead))
                                : Math.min(this.target.depth, Math.max(wanted, frame.depth - lead)));
  }

  /** A key that was held is let go: the needle stops at once, but does not turn back to where the last frame saw it. */
  stop(): void {
    const frame = this.session.frame;
    if (!this.active || !frame || frame.paused) return;
    const room = this.target.speed * STOP_WITHIN_S;
    this.setDepth(clamp(this.target.depth, frame.depth - room, frame.depth + room));
  }

  roll(degrees: number): void {
    if (!this.begin()) return;
    this.target.roll += degrees;
    this.send();
  }

  tilt(left: number, anterior: number): void {
    if (!this.begin()) return;
    const most = this.session.scene?.limits.tilt_deg ?? 10;
    this.target.tiltLeft = clamp(this.target.tiltLeft + left, -most, most);
    this.target.tiltAnterior = clamp(this.target.tiltAnterior + anterior, -most, most);
    this.send();
  }

  straighten(): void {
    if (!this.begin()) return;
    this.target.tiltLeft = this.target.tiltAnterior = 0;
    this.send();
  }

  private begin(): boolean {
    const { session } = this;
    if (!session.steering || !session.frame) return false;
    if (session.guest || session.frame.paused) {
      if (Date.now() - this.toldAt > 4000) {
        if (session.guest) session.notify(`The needle follows ${session.guest}, not this page.`, 'Start stylet serve without --hand to push it here.');
        else session.notify('The simulation is paused.', 'Press Space or "Resume" and push again.');
      }
      this.toldAt = Date.now();
      return false;
    }
    this.active = true;
    return true;
  }

  private follow(): void {
    const { frame } = this.session;
    if (!frame) return;
    this.target.depth = frame.depth;
    [this.target.roll, this.target.tiltLeft, this.target.tiltAnterior] = [frame.hand[0], frame.hand[1], frame.hand[2]];
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }

  private send(): void {
    this.changed = true;
    this.tell();
    if (this.timer) return;
    const wait = Math.max(0, this.sentAt + SEND_EVERY_MS - performance.now());
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      if (!this.changed) return;
      this.changed = false;
      this.sentAt = performance.now();
      this.session.sendHand(this.target);
    }, wait);
  }
}

export function clamp(value: number, low: number, high: number): number {
  return Math.max(low, Math.min(high, value));
}

function nearest(values: number[], wanted: number): number {
  return values.reduce((best, v) => (Math.abs(v - wanted) < Math.abs(best - wanted) ? v : best));
}
