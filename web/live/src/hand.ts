// SPDX-License-Identifier: GPL-3.0-or-later
// The target of the hand. It follows the simulation until the user pushes, and again after a jump (reset, another
// hole).
import { samePatient, type Scene } from './scene';
import type { Session } from './session';
import type { Frame, Hand } from './wire';

export const SPEEDS = [5, 20, 50];         // [mm/s]
const MOST_LEAD_S = 0.25;                  // while a key is held, the target is at most this time ahead of the needle
const TAP_MS = 1000 / 60;                  // shortest duration of a motion by a key
const SEND_EVERY_MS = 1000 / 60;
const AT_TARGET_MM = 0.05;

/**
 * The source of the target's depth. followed: the simulation, because nobody pushes. driven: this page, because the
 * user pushes. stopping: the user has let go and the page waits until the needle stands still. Only the server knows
 * the depth at which it stops, because the frames that this page receives are some hundredths of a second old.
 */
type Depth = 'followed' | 'driven' | 'stopping';

export class HandControl {
  readonly target: Hand = { depth: 0, speed: 20, roll: 0, tiltLeft: 0, tiltAnterior: 0 };
  private depth: Depth = 'followed';
  private turned = false;        // roll and tilt are set by this page
  private pace = 1;              // share of the speed, below 1 for a half-pressed trigger
  private aimed = 0;             // [mm] last depth sent; the needle has not passed it
  private pending = 0;           // [mm] push that starts when the needle stands still
  private stoodAt = NaN;         // [mm] depth in the last frame since the user let go
  private heldAt = 0;
  private stopTimer = 0;
  private changed = false;
  private sentAt = 0;
  private timer = 0;
  private toldAt = 0;            // [ms] time of the last notice that the needle cannot be pushed
  private readonly listeners: (() => void)[] = [];

  constructor(private readonly session: Session) {
    session.on('frame', (frame) => this.follow(frame));
    session.on('restart', () => this.rest());
    session.on('event', (e) => e.kind === 'started' && this.rest());
    session.on('status', () => session.steering || this.rest());
    session.on('stopped', () => this.stopped());
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

  /** Discards the target, because the needle jumps. */
  rest(): void {
    this.depth = 'followed';
    this.turned = false;
    this.changed = false;
    this.pending = 0;
    this.heldAt = 0;
    clearTimeout(this.stopTimer);
  }

  setSpeed(speed: number): void {
    this.target.speed = speed;
    this.tell();
  }

  setDepth(depth: number): void {
    if (this.begin()) this.drive(depth, 1);
  }

  /** Pushes the needle by `mm`; pulls it when negative. */
  push(mm: number): void {
    if (!this.begin()) return;
    if (this.depth === 'stopping') this.pending += mm;
    else this.drive(this.target.depth + mm, 1);
  }

  /** Pushes while it is called at every repaint, until stop(). @param direction −1 … 1, sign and share of the speed */
  hold(direction: number): void {
    const { frame } = this.session;
    if (!this.begin() || !frame) return;
    clearTimeout(this.stopTimer);
    if (this.heldAt === 0) this.heldAt = performance.now();
    const ahead = frame.depth + direction * this.target.speed * MOST_LEAD_S;
    const before = this.depth === 'followed' ? frame.depth : this.aimed;
    this.drive(direction > 0 ? Math.max(before, ahead) : Math.min(before, ahead), Math.abs(direction));
  }

  /**
   * Stops the needle where it is. The command is to stay, not to go to a depth, because this page's depth is outdated.
   */
  stop(): void {
    clearTimeout(this.stopTimer);
    const tapped = this.heldAt + TAP_MS - performance.now();
    if (this.heldAt > 0 && tapped > 0) {
      this.stopTimer = window.setTimeout(() => this.stop(), tapped);
      return;
    }
    this.heldAt = 0;
    if (this.depth !== 'driven') return;
    this.depth = 'stopping';
    this.stoodAt = NaN;
    this.target.depth = this.session.frame?.depth ?? this.target.depth;
    this.changed = true;
    this.flush();
    this.tell();
  }

  roll(degrees: number): void {
    if (!this.begin()) return;
    this.turned = true;
    this.target.roll += degrees;
    this.send();
  }

  tilt(left: number, anterior: number): void {
    if (!this.begin()) return;
    this.turned = true;
    const most = this.session.scene?.limits.tilt_deg ?? 10;
    this.target.tiltLeft = clamp(this.target.tiltLeft + left, -most, most);
    this.target.tiltAnterior = clamp(this.target.tiltAnterior + anterior, -most, most);
    this.send();
  }

  straighten(): void {
    if (!this.begin()) return;
    this.turned = true;
    this.target.tiltLeft = this.target.tiltAnterior = 0;
    this.send();
  }

  /** The server has stopped the needle. The user is told if it was on its way. */
  private stopped(): void {
    const { session } = this;
    const moved = this.depth === 'driven' && session.frame && Math.abs(session.frame.depth - this.target.depth) > AT_TARGET_MM;
    if (moved && session.steering && !session.guest) session.notify('The needle was stopped where it is, because this page did not answer.', 'Push again to go on.');
    this.rest();
  }

  private begin(): boolean {
    const { session } = this;
    if (!session.steering || !session.frame) return false;
    if (session.guest || session.frame.paused) {
      if (Date.now() - this.toldAt > 4000) {
        if (session.guest) session.notify(`The needle follows ${session.guest}, not this page.`, 'Start stylet serve without --hand to move the needle in this page.');
        else session.notify('The simulation is paused.', 'Press Space or "Resume", then push again.');
      }
      this.toldAt = Date.now();
      return false;
    }
    return true;
  }

  private drive(depth: number, pace: number): void {
    const limits = this.session.scene?.limits;
    this.depth = 'driven';
    this.pace = pace;
    this.target.depth = this.aimed = limits ? clamp(depth, -limits.behind_mm, limits.depth_mm) : depth;
    this.send();
  }

  private follow(frame: Frame): void {
    if (!this.turned) [this.target.roll, this.target.tiltLeft, this.target.tiltAnterior] = [frame.hand[0], frame.hand[1], frame.hand[2]];
    if (this.depth === 'driven') return;
    this.target.depth = frame.depth;
    if (this.depth === 'followed') return;
    const stands = frame.paused || frame.depth === this.stoodAt;
    this.stoodAt = frame.depth;
    if (!stands) return;
    this.depth = 'followed';
    const pushed = this.pending;
    this.pending = 0;
    if (pushed !== 0) this.push(pushed);
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }

  private send(): void {
    this.changed = true;
    this.tell();
    if (this.timer) return;
    const wait = Math.max(0, this.sentAt + SEND_EVERY_MS - performance.now());
    this.timer = window.setTimeout(() => this.flush(), wait);
  }

  /** Sends the target. A speed of 0 means that the depth stays as it is. */
  private flush(): void {
    clearTimeout(this.timer);
    this.timer = 0;
    if (!this.changed) return;
    this.changed = false;
    this.sentAt = performance.now();
    this.session.sendHand({ ...this.target, speed: this.depth === 'driven' ? this.pace * this.target.speed : 0 });
  }
}

export function clamp(value: number, low: number, high: number): number {
  return Math.max(low, Math.min(high, value));
}

function nearest(values: number[], wanted: number): number {
  return values.reduce((best, v) => (Math.abs(v - wanted) < Math.abs(best - wanted) ? v : best));
}
