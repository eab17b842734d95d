// SPDX-License-Identifier: GPL-3.0-or-later
// The needle as a tube along its centreline, with its real diameter and a conical tip.
import * as THREE from 'three';
import type { Frame } from '../data';

const SIDES = 20;

export class NeedleMesh {
  readonly object: THREE.Mesh;

  constructor(private readonly diameter: number) {
    const material = new THREE.MeshStandardMaterial({ color: '#2d333d', roughness: 0.35, metalness: 0.5, side: THREE.DoubleSide });
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.object.renderOrder = -2;
    this.object.frustumCulled = false;
  }

  show(frame: Frame): void {
    this.object.geometry.dispose();
    this.object.geometry = tube(frame.needle, this.diameter / 2);
    this.object.visible = frame.needle.length >= 6;
  }
}

/** Rings around the points, radius r up to the last diameter of length, from there falling to zero. */
function tube(line: Float32Array, r: number): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  const count = line.length / 3;
  if (count < 2) return geometry;
  const points: THREE.Vector3[] = [];
  for (let i = 0; i < count; i++) points.push(new THREE.Vector3().fromArray(line, 3 * i));
  const { centres, radii } = withTip(points, r);

  const position: number[] = [];
  const index: number[] = [];
  const tangent = new THREE.Vector3();
  const side = new THREE.Vector3();
  let across = new THREE.Vector3();
  centres.forEach((centre, i) => {
    const before = centres[Math.max(0, i - 1)];
    const after = centres[Math.min(centres.length - 1, i + 1)];
    tangent.subVectors(after, before).normalize();
    if (i === 0) across = Math.abs(tangent.z) < 0.9 ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(1, 0, 0);
    across.addScaledVector(tangent, -across.dot(tangent)).normalize();  // carried along without twist
    side.crossVectors(tangent, across);
    for (let k = 0; k < SIDES; k++) {
      const angle = (2 * Math.PI * k) / SIDES;
      const p = centre.clone().addScaledVector(across, radii[i] * Math.cos(angle)).addScaledVector(side, radii[i] * Math.sin(angle));
      position.push(p.x, p.y, p.z);
      if (i === 0) continue;
      const a = (i - 1) * SIDES + k;
      const b = (i - 1) * SIDES + ((k + 1) % SIDES);
      index.push(a, b, a + SIDES, b, b + SIDES, a + SIDES);
    }
  });
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  return geometry;
}

function withTip(points: THREE.Vector3[], r: number): { centres: THREE.Vector3[]; radii: number[] } {
  const centres = [...points];
  const tip = centres[centres.length - 1];
  let left = 2 * r;
  while (centres.length > 2 && centres[centres.length - 1].distanceTo(centres[centres.length - 2]) < left) {
    left -= centres[centres.length - 1].distanceTo(centres[centres.length - 2]);
    centres.pop();
  }
  const last = centres.pop() as THREE.Vector3;
  const before = centres[centres.length - 1];
  const length = last.distanceTo(before);
  const share = length > 0 ? Math.min(0.9, left / length) : 0;
  centres.push(last.clone().lerp(before, share), tip);
  return { centres, radii: centres.map((_, i) => (i + 1 < centres.length ? r : r / 100)) };
}
