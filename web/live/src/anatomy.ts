// SPDX-License-Identifier: GPL-3.0-or-later
// The current positions of the surfaces' nodes: one buffer, which each frame updates and every view reads.
import type { Scene } from './scene';
import type { Frame } from './wire';

export class Anatomy {
  readonly position: Float32Array;      // (3 × nodes) [mm] LPS, deformed
  readonly displacement: Float32Array;  // (nodes) [mm] magnitude
  largest = 0;                          // [mm] largest displacement
  tissueMoved = false;                  // whether the last frame moved it; otherwise it need not be drawn again
  needleMoved = false;
  private last: Frame | null = null;

  constructor(readonly scene: Scene) {
    this.position = scene.points.slice();
    this.displacement = new Float32Array(scene.points.length / 3);
  }

  /** Moves the nodes to their positions in a frame. A frame without displacement does not move them. */
  show(frame: Frame): void {
    this.needleMoved = !this.last || !same(frame.line, this.last.line) || !same(frame.contacts, this.last.contacts);
    const { displacement: u, unit } = frame;
    const comes = frame.shown && u.length === this.position.length;
    this.tissueMoved = comes && !(this.last && this.last.unit === unit && same(u, this.last.displacement));
    if (comes || !this.last) this.last = frame;
    else this.last = { ...frame, displacement: this.last.displacement, unit: this.last.unit };
    if (this.tissueMoved) this.move(u, unit);
  }

  private move(u: Int16Array, unit: number): void {
    const { points } = this.scene;
    this.largest = 0;
    for (let i = 0; i < this.displacement.length; i++) {
      const [x, y, z] = [u[3 * i] * unit, u[3 * i + 1] * unit, u[3 * i + 2] * unit];
      this.position[3 * i] = points[3 * i] + x;
      this.position[3 * i + 1] = points[3 * i + 1] + y;
      this.position[3 * i + 2] = points[3 * i + 2] + z;
      this.displacement[i] = Math.sqrt(x * x + y * y + z * z);
      if (this.displacement[i] > this.largest) this.largest = this.displacement[i];
    }
  }
}

function same(a: Float32Array | Int16Array, b: Float32Array | Int16Array): boolean {
  if (a.length !== b.length) return false;
  for (let i = 0; i < a.length; i++) if (a[i] !== b[i]) return false;
  return true;
}
