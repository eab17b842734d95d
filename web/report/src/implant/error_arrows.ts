// SPDX-License-Identifier: GPL-3.0-or-later
// Arrows in the 3D view from the planned places to where the seeds rest, in the colours of the thirds.
import * as THREE from 'three';
import type { ImplantData, Seed } from './data';

const SHAFT_MM = 0.22;  // radius
const HEAD_MM = 0.62;   // radius at its base
const LONGEST_HEAD_MM = 1.5;
const DOT_MM = 0.45;    // radius of the mark at the planned place

export class ErrorArrows {
  readonly object = new THREE.Group();
  private readonly moved: Seed[];
  private readonly shafts: THREE.InstancedMesh;
  private readonly heads: THREE.InstancedMesh;

  constructor({ seeds, thirds }: ImplantData) {
    this.moved = seeds.filter((seed) => seed.rest_mm);
    // Arrows are shorter than seeds, which would hide them: they are drawn over everything else.
    const material = new THREE.MeshStandardMaterial({ roughness: 0.6, depthTest: false, transparent: true });
    const many = (shape: THREE.BufferGeometry, of: Seed[]) => {
      const mesh = new THREE.InstancedMesh(shape, material, of.length);
      of.forEach((seed, k) => mesh.setColorAt(k, new THREE.Color(thirds[seed.third].color)));
      mesh.frustumCulled = false;
      mesh.renderOrder = 1000;
      this.object.add(mesh);
      return mesh;
    };
    // Both shapes have a length of 1 along y and begin at the origin.
    this.shafts = many(new THREE.CylinderGeometry(SHAFT_MM, SHAFT_MM, 1, 10).translate(0, 0.5, 0), this.moved);
    this.heads = many(new THREE.ConeGeometry(HEAD_MM, 1, 14).translate(0, 0.5, 0), this.moved);
    const dots = many(new THREE.SphereGeometry(DOT_MM, 14, 10), seeds);
    seeds.forEach((seed, k) => dots.setMatrixAt(k, new THREE.Matrix4().setPosition(...seed.planned_mm)));
    this.stretch(1);
  }

  /** Draws each arrow with the length of its error, multiplied by a factor. */
  stretch(times: number): void {
    const along = new THREE.Vector3(0, 1, 0);
    this.moved.forEach((seed, k) => {
      const from = new THREE.Vector3(...seed.planned_mm);
      const way = new THREE.Vector3(...(seed.rest_mm ?? seed.planned_mm)).sub(from).multiplyScalar(times);
      const length = Math.max(way.length(), 1e-3);
      const turn = new THREE.Quaternion().setFromUnitVectors(along, way.clone().divideScalar(length));
      const head = Math.min(LONGEST_HEAD_MM, 0.5 * length);
      const neck = from.clone().addScaledVector(way, 1 - head / length);
      const slim = head / LONGEST_HEAD_MM;  // short arrows have small heads
      this.shafts.setMatrixAt(k, new THREE.Matrix4().compose(from, turn, new THREE.Vector3(1, length - head, 1)));
      this.heads.setMatrixAt(k, new THREE.Matrix4().compose(neck, turn, new THREE.Vector3(slim, head, slim)));
    });
    this.shafts.instanceMatrix.needsUpdate = true;
    this.heads.instanceMatrix.needsUpdate = true;
  }
}
