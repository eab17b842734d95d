// SPDX-License-Identifier: GPL-3.0-or-later
// The rigid motion of the gland: a least-squares fit to the displayed displacement of its surface, in which each node
// has its share of the surface's area as weight. Reports compute the motion from the gland's volume instead.
import { glandTriangles, type Scene } from './scene';

type Vector = [number, number, number];
const DEGREES = 180 / Math.PI;

export function length([x, y, z]: Vector): number {
  return Math.hypot(x, y, z);
}

function cross(ax: number, ay: number, az: number, bx: number, by: number, bz: number): Vector {
  return [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
}

export class GlandFit {
  readonly shift: Vector = [0, 0, 0];     // [mm] LPS
  readonly rotation: Vector = [0, 0, 0];  // [degrees] about LR, AP and SI, right-handed
  private readonly nodes: Uint32Array;    // node numbers of the scene
  private readonly weight: Float64Array;  // (nodes) their sum is 1
  private readonly arm: Float64Array;     // (3 × nodes) [mm] vectors from the centroid
  private readonly inverse: Vector[];     // J⁻¹ [1/mm²], inverse of the second moments

  /** The fit for a scene; null if the scene has no target. */
  static of(scene: Scene): GlandFit | null {
    const triangles = glandTriangles(scene);
    return triangles.length > 0 ? new GlandFit(scene.points, triangles) : null;
  }

  private constructor(points: Float32Array, triangles: Uint32Array) {
    const areas = new Map<number, number>();
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
      const area = length(cross(points[b] - points[a], points[b + 1] - points[a + 1], points[b + 2] - points[a + 2],
                                points[c] - points[a], points[c + 1] - points[a + 1], points[c + 2] - points[a + 2]));
      for (let k = 0; k < 3; k++) areas.set(triangles[t + k], (areas.get(triangles[t + k]) ?? 0) + area);
    }
    this.nodes = Uint32Array.from(areas.keys());
    this.weight = Float64Array.from(areas.values());
    const whole = this.weight.reduce((sum, w) => sum + w, 0);
    this.weight.forEach((w, i) => (this.weight[i] = w / whole));
    const centre: Vector = [0, 0, 0];
    this.nodes.forEach((node, i) => centre.forEach((_, k) => (centre[k] += this.weight[i] * points[3 * node + k])));
    this.arm = new Float64Array(3 * this.nodes.length);
    let [xx, yy, zz, xy, yz, zx] = [0, 0, 0, 0, 0, 0];
    this.nodes.forEach((node, i) => {
      const [x, y, z] = centre.map((c, k) => (this.arm[3 * i + k] = points[3 * node + k] - c));
      const w = this.weight[i];
      xx += w * x * x; yy += w * y * y; zz += w * z * z;
      xy += w * x * y; yz += w * y * z; zx += w * z * x;
    });
    const rows: Vector[] = [[yy + zz, -xy, -zx], [-xy, zz + xx, -yz], [-zx, -yz, xx + yy]];
    const cofactors = [cross(...rows[1], ...rows[2]), cross(...rows[2], ...rows[0]), cross(...rows[0], ...rows[1])];
    const determinant = rows[0].reduce((sum, value, k) => sum + value * cofactors[0][k], 0);
    this.inverse = cofactors.map((row) => row.map((value) => value / determinant) as Vector);  // symmetric
  }

  /** Computes the fit. @param displacement (3 × nodes of the scene) in `unit` mm */
  update(displacement: Int16Array, unit: number): void {
    const { shift, rotation, weight, arm } = this;
    let [mx, my, mz] = [0, 0, 0];
    shift.fill(0);
    for (let i = 0; i < this.nodes.length; i++) {
      const from = 3 * this.nodes[i];
      const w = unit * weight[i];
      const [ux, uy, uz] = [w * displacement[from], w * displacement[from + 1], w * displacement[from + 2]];
      const [x, y, z] = [arm[3 * i], arm[3 * i + 1], arm[3 * i + 2]];
      shift[0] += ux; shift[1] += uy; shift[2] += uz;
      mx += y * uz - z * uy; my += z * ux - x * uz; mz += x * uy - y * ux;
    }
    this.inverse.forEach(([a, b, c], k) => (rotation[k] = DEGREES * (a * mx + b * my + c * mz)));
  }

  reset(): void {
    this.shift.fill(0);
    this.rotation.fill(0);
  }
}
