// SPDX-License-Identifier: GPL-3.0-or-later
// Seeds in 3D: planned seeds pale, dropped seeds where they are now, and a line from each to its planned place.
import * as THREE from 'three';
import { nextSeed, placesNow } from '../implant/implant';
import { SEED } from '../palette';
import type { Session } from '../session';

const LEAST_RADIUS_MM = 0.55;  // drawn thicker than they are, so that they can be seen
const UP = new THREE.Vector3(0, 1, 0);
const PALE = new THREE.Color('#ffffff');
const NEXT = new THREE.Color(SEED);
const HIDDEN = new THREE.Matrix4().makeScale(0, 0, 0);

function bodies(count: number, length: number, radius: number, material: THREE.Material): THREE.InstancedMesh {
  const shape = new THREE.CapsuleGeometry(radius, Math.max(0.1, length - 2 * radius), 4, 10);
  const mesh = new THREE.InstancedMesh(shape, material, Math.max(1, count));
  mesh.frustumCulled = false;
  return mesh;
}

export class SeedBodies {
  readonly object = new THREE.Group();
  private planned: THREE.InstancedMesh | null = null;
  private dropped: THREE.InstancedMesh | null = null;
  private readonly errors = new THREE.LineSegments(new THREE.BufferGeometry(),
    new THREE.LineBasicMaterial({ color: SEED, transparent: true, opacity: 0.75, depthTest: false }));
  private readonly paleMaterial = new THREE.MeshStandardMaterial({ color: '#ffffff', roughness: 0.6, emissive: '#5b6470', emissiveIntensity: 0.35 });
  private readonly seedMaterial = new THREE.MeshStandardMaterial({ color: SEED, roughness: 0.45, emissive: SEED, emissiveIntensity: 0.35 });
  private key = '';
  private readonly matrix = new THREE.Matrix4();
  private readonly turn = new THREE.Quaternion();
  private readonly at = new THREE.Vector3();
  private readonly along = new THREE.Vector3();
  private readonly scale = new THREE.Vector3(1, 1, 1);

  constructor() {
    this.errors.frustumCulled = false;
    this.errors.renderOrder = 900;
    this.object.add(this.errors);
    this.object.visible = false;
  }

  /** Shows the seeds of a session. @param on false: hides them */
  show(session: Session, on: boolean): void {
    const { plan, implant, seeds } = session;
    this.object.visible = on && plan !== null;
    if (!plan || !this.object.visible) return;
    const all = plan.needles.flatMap((needle) => needle.seeds);
    const key = `${all.length} ${plan.seed_length_mm}`;
    if (key !== this.key) this.build(key, all.length, plan.seed_length_mm, Math.max(LEAST_RADIUS_MM, plan.seed_diameter_mm / 2));
    const done = new Set(implant?.seeds.map((seed) => seed.number));
    const next = nextSeed(plan, implant);
    all.forEach((seed, i) => this.planned!.setColorAt(i, seed === next ? NEXT : PALE));
    this.planned!.instanceColor!.needsUpdate = true;
    all.forEach((seed, i) => this.place(this.planned!, i, done.has(seed.number) ? null : seed.planned_mm, seed.axis, seed === next ? 1.6 : 1));
    const now = placesNow(implant, seeds);
    const lines = new Float32Array(6 * now.length);
    for (let i = 0; i < all.length; i++) this.place(this.dropped!, i, now[i] ?? null, implant?.seeds[i]?.axis ?? [0, 0, 1], 1);
    now.forEach((at, i) => at && lines.set([...implant!.seeds[i].planned_mm, ...at], 6 * i));
    this.errors.geometry.setAttribute('position', new THREE.BufferAttribute(lines, 3));
    this.planned!.instanceMatrix.needsUpdate = this.dropped!.instanceMatrix.needsUpdate = true;
  }

  private build(key: string, count: number, length: number, radius: number): void {
    this.key = key;
    for (const old of [this.planned, this.dropped]) {
      if (!old) continue;
      this.object.remove(old);
      old.geometry.dispose();
      old.dispose();
    }
    this.planned = bodies(count, length, 0.8 * radius, this.paleMaterial);
    this.dropped = bodies(count, length, radius, this.seedMaterial);
    this.object.add(this.planned, this.dropped);
  }

  private place(mesh: THREE.InstancedMesh, i: number, at: ArrayLike<number> | null, axis: ArrayLike<number>, wide: number): void {
    if (!at) return mesh.setMatrixAt(i, HIDDEN);
    this.along.set(axis[0], axis[1], axis[2]).normalize();
    this.turn.setFromUnitVectors(UP, this.along);
    this.scale.set(wide, 1, wide);
    mesh.setMatrixAt(i, this.matrix.compose(this.at.set(at[0], at[1], at[2]), this.turn, this.scale));
  }
}
