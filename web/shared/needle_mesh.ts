// SPDX-License-Identifier: GPL-3.0-or-later
// The needle as a tube along its centreline, with its real diameter and a conical tip. The buffers are reused for each
// new curve and grow only with the number of points.
import * as THREE from 'three';

const SIDES = 20;

export class NeedleMesh {
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
  private capacity = 0;  // number of rings for which buffers are allocated
  private centres = new Float32Array(0);
  private radii = new Float32Array(0);
  private position = new THREE.BufferAttribute(new Float32Array(0), 3);
  private normal = new THREE.BufferAttribute(new Float32Array(0), 3);
  private readonly tangent = new THREE.Vector3();
  private readonly across = new THREE.Vector3();
  private readonly side = new THREE.Vector3();

  constructor(private readonly diameter: number, color = '#2d333d') {
    const material = new THREE.MeshStandardMaterial({ color, roughness: 0.35, metalness: 0.5, side: THREE.DoubleSide });
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.object.renderOrder = -2;
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  /** @param line [mm] LPS (3 × points) base to tip */
  show(line: Float32Array): void {
    const points = line.length / 3;
    this.object.visible = points >= 2;
    if (points < 2) return;
    if (points + 1 > this.capacity) this.grow(points + 1);
    const rings = this.place(line, points);
    const { tangent, across, side } = this;
    for (let i = 0; i < rings; i++) {
      const before = 3 * Math.max(0, i - 1);
      const after = 3 * Math.min(rings - 1, i + 1);
      tangent.set(this.centres[after] - this.centres[before], this.centres[after + 1] - this.centres[before + 1],
                  this.centres[after + 2] - this.centres[before + 2]).normalize();
      if (i === 0) across.set(0, 0, 0).setComponent(Math.abs(tangent.z) < 0.9 ? 2 : 0, 1);
      across.addScaledVector(tangent, -across.dot(tangent)).normalize();  // transported without twist
      side.crossVectors(tangent, across);
      for (let k = 0; k < SIDES; k++) {
        const c = Math.cos((2 * Math.PI * k) / SIDES);
        const s = Math.sin((2 * Math.PI * k) / SIDES);
        const [x, y, z] = [c * across.x + s * side.x, c * across.y + s * side.y, c * across.z + s * side.z];
        const r = this.radii[i];
        const vertex = i * SIDES + k;
        this.position.setXYZ(vertex, this.centres[3 * i] + r * x, this.centres[3 * i + 1] + r * y, this.centres[3 * i + 2] + r * z);
        this.normal.setXYZ(vertex, x, y, z);
      }
    }
    this.position.needsUpdate = true;
    this.normal.needsUpdate = true;
    this.object.geometry.setDrawRange(0, (rings - 1) * SIDES * 6);
  }

  /** Computes centres and radii of the rings. Over the last diameter of length the radius decreases to 0. */
  private place(line: Float32Array, points: number): number {
    const r = this.diameter / 2;
    let left = this.diameter;
    let last = points - 1;  // this point is replaced by the start of the cone
    while (last > 1 && distance(line, last, last - 1) < left) left -= distance(line, last, --last);
    this.centres.set(line.subarray(0, 3 * last));
    const length = distance(line, last, last - 1);
    const share = length > 0 ? Math.min(0.9, left / length) : 0;
    for (let k = 0; k < 3; k++) {
      this.centres[3 * last + k] = line[3 * last + k] + share * (line[3 * (last - 1) + k] - line[3 * last + k]);
      this.centres[3 * (last + 1) + k] = line[3 * (points - 1) + k];
    }
    this.radii.fill(r, 0, last + 1);
    this.radii[last + 1] = r / 100;
    return last + 2;
  }

  private grow(rings: number): void {
    this.capacity = 2 * rings;
    this.centres = new Float32Array(3 * this.capacity);
    this.radii = new Float32Array(this.capacity);
    const attribute = () => new THREE.BufferAttribute(new Float32Array(3 * SIDES * this.capacity), 3).setUsage(THREE.DynamicDrawUsage);
    const index = new Uint32Array(6 * SIDES * (this.capacity - 1));
    let at = 0;
    for (let i = 1; i < this.capacity; i++) {
      for (let k = 0; k < SIDES; k++) {
        const a = (i - 1) * SIDES + k;
        const b = (i - 1) * SIDES + ((k + 1) % SIDES);
        for (const vertex of [a, b, a + SIDES, b, b + SIDES, a + SIDES]) index[at++] = vertex;
      }
    }
    this.position = attribute();
    this.normal = attribute();
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    this.object.geometry.setIndex(new THREE.BufferAttribute(index, 1));
    this.object.geometry.setAttribute('position', this.position);
    this.object.geometry.setAttribute('normal', this.normal);
  }
}

function distance(line: Float32Array, a: number, b: number): number {
  return Math.hypot(line[3 * a] - line[3 * b], line[3 * a + 1] - line[3 * b + 1], line[3 * a + 2] - line[3 * b + 2]);
}
