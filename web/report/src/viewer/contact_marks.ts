// SPDX-License-Identifier: GPL-3.0-or-later
// Contact points: balls where tissue sticks to the needle, rings where it slips, a cone's place for the tip.
import * as THREE from 'three';
import type { Frame } from '../data';

const CAPACITY = 512;
export const STICK_COLOR = '#009e73';
export const SLIP_COLOR = '#d55e00';
export const TIP_COLOR = '#f0e442';

export class ContactMarks {
  readonly object = new THREE.Group();
  private readonly kinds: THREE.InstancedMesh[];

  constructor(needleDiameter: number) {
    const r = needleDiameter;
    const make = (geometry: THREE.BufferGeometry, color: string) => {
      const mesh = new THREE.InstancedMesh(geometry, new THREE.MeshStandardMaterial({ color, roughness: 0.6 }), CAPACITY);
      mesh.frustumCulled = false;
      mesh.renderOrder = -1;
      mesh.count = 0;
      this.object.add(mesh);
      return mesh;
    };
    // Numbered like the state in Frame.contacts: slipping, sticking, tip.
    this.kinds = [
      make(new THREE.TorusGeometry(0.95 * r, 0.3 * r, 10, 24), SLIP_COLOR),
      make(new THREE.SphereGeometry(1.05 * r, 18, 14), STICK_COLOR),
      make(new THREE.OctahedronGeometry(1.3 * r), TIP_COLOR),
    ];
  }

  show(frame: Frame): void {
    const counts = [0, 0, 0];
    const matrix = new THREE.Matrix4();
    const turn = new THREE.Quaternion();
    const one = new THREE.Vector3(1, 1, 1);
    const axis = new THREE.Vector3(0, 0, 1);
    for (let i = 0; i < frame.contacts.length; i += 4) {
      const kind = frame.contacts[i + 3];
      if (counts[kind] >= CAPACITY) continue;
      const place = new THREE.Vector3().fromArray(frame.contacts, i);
      turn.setFromUnitVectors(axis, tangentNear(frame.needle, place));
      this.kinds[kind].setMatrixAt(counts[kind]++, matrix.compose(place, turn, one));
    }
    this.kinds.forEach((mesh, k) => {
      mesh.count = counts[k];
      mesh.instanceMatrix.needsUpdate = true;
    });
  }
}

/** Direction of the needle at its point nearest to a place. */
function tangentNear(line: Float32Array, place: THREE.Vector3): THREE.Vector3 {
  let best = 0;
  let distance = Infinity;
  const p = new THREE.Vector3();
  const last = line.length / 3 - 1;
  for (let i = 0; i <= last; i++) {
    const d = p.fromArray(line, 3 * i).distanceToSquared(place);
    if (d < distance) [best, distance] = [i, d];
  }
  if (last < 1) return new THREE.Vector3(0, 0, 1);
  const from = new THREE.Vector3().fromArray(line, 3 * Math.max(0, best - 1));
  const to = new THREE.Vector3().fromArray(line, 3 * Math.min(last, best + 1));
  return to.sub(from).normalize();
}
