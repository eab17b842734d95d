// SPDX-License-Identifier: GPL-3.0-or-later
// A plane of a section: its position, and whether it follows the needle.
import { clamp } from '../hand';
import { holes, organBounds, regionTriangles, samePatient, type Scene } from '../scene';
import type { Session } from '../session';
import { tipOf } from './needle_crossing';

const TIP = new Float32Array(3);

export type PlaneName = 'transverse' | 'sagittal';

export class Plane {
  value = 0;            // [mm] position on the axis
  follows = true;
  low = -50;
  high = 50;
  private near = -Infinity;  // [mm] a plane that follows the tip waits here until the tip arrives
  private holeOf: [Scene, string, number | undefined] | null = null;
  private readonly listeners: (() => void)[] = [];

  constructor(readonly name: PlaneName, private readonly session: Session) {
    let known: Scene | null = null;
    session.on('scene', (scene) => {
      this.setRange(scene, known !== null && samePatient(known, scene));
      known = scene;
    });
    session.on('frame', () => this.update());
    session.on('status', () => this.update());
  }

  /** The axis perpendicular to the plane. */
  get axis(): 0 | 2 {
    return this.name === 'transverse' ? 2 : 0;
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  set(value: number): void {
    this.follows = false;
    this.move(value);
  }

  follow(on: boolean): void {
    this.follows = on;
    this.update();
    this.tell();
  }

  private update(): void {
    if (!this.follows) return;
    const wanted = this.name === 'transverse' ? this.tipZ() : this.holeX();
    if (wanted !== undefined) this.move(Math.max(this.near, wanted));
  }

  private tipZ(): number | undefined {
    const { frame } = this.session;
    return frame ? tipOf(frame, TIP)[2] : undefined;
  }

  private holeX(): number | undefined {
    const { scene, status, frame } = this.session;
    if (scene?.template && status?.hole && (this.holeOf?.[0] !== scene || this.holeOf[1] !== status.hole)) {
      this.holeOf = [scene, status.hole, holes(scene.template).find((h) => h.name === status.hole)?.x];
    }
    return (status?.hole ? this.holeOf?.[2] : undefined)
      ?? scene?.insertions.find((i) => i.name === status?.insertion)?.entry_mm[0] ?? frame?.base[0];
  }

  private move(value: number): void {
    const valid = clamp(value, this.low, this.high);
    if (valid === this.value) return;
    this.value = valid;
    this.tell();
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }

  /**
   * Sets the range of the plane. A plane that follows the tip starts at the target's near end (its apex), because that
   * is the most useful picture before the needle arrives.
   * @param again whether the same patient was shown before; then a plane that the user has moved stays
   */
  private setRange(scene: Scene, again: boolean): void {
    const [low, high] = organBounds(scene)[this.axis];
    this.low = low;
    this.high = high;
    const target = scene.regions.findIndex((r) => r.target);
    if (target >= 0 && this.name === 'transverse') {
      let first = Infinity;
      for (const node of regionTriangles(scene, target)) first = Math.min(first, scene.points[3 * node + 2]);
      this.near = first + 2;
    } else this.near = -Infinity;
    this.follows ||= !again;
    this.value = this.follows ? (low + high) / 2 : clamp(this.value, low, high);
    this.update();
    this.tell();
  }
}
