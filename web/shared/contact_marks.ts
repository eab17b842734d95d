// SPDX-License-Identifier: GPL-3.0-or-later
// Marks of contacts: balls where tissue sticks to the needle, rings where it slips, an octahedron at the tip.
import * as THREE from 'three';

const CAPACITY = 512;
const AXIS = new THREE.Vector3(0, 0, 1);
const ONE = new THREE.Vector3(1, 1, 1);
export const STICK_COLOR = '#009e73';
export const SLIP_COLOR = '#d55e00';
export const TIP_COLOR = '#f0e442';

export class ContactMarks {
  readonly object = new THREE.Group();
  private readonly kinds: THREE.InstancedMesh[];
  private readonly counts = [0, 0, 0];
  private readonly matrix = new THREE.Matrix4();
  private readonly turn = new THREE.Quaternion();
  private readonly place = new THREE.Vector3();
  private readonly from = new THREE.Vector3();
  private readonly tangent = new THREE.Vector3();

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
    // Indexed by the state of a contact: slipping, sticking, tip.
    this.kinds = [
      make(new THREE.TorusGeometry(0.95 * r, 0.3 * r, 10, 24), SLIP_COLOR),
      make(new THREE.SphereGeometry(1.05 * r, 18, 14), STICK_COLOR),
      make(new THREE.OctahedronGeometry(1.3 * r), TIP_COLOR),
    ];
  }

  /**
   * @param needle [mm] LPS (3 × points) centreline of the needle; rings lie around it
   * @param contacts (4 × contacts) x y z [mm] LPS, state 0 slipping, 1 sticking, 2 tip
   */
  show(needle: Float32Array, contacts: Float32Array): void {
    this.counts.fill(0);
    for (let i = 0; i < contacts.length; i += 4) {
      const kind = contacts[i + 3];
      if (this.counts[kind] >= CAPACITY) continue;
      this.place.fromArray(contacts, i);
      this.setTangentNear(needle);
      this.turn.setFromUnitVectors(AXIS, this.tangent);
      this.kinds[kind].setMatrixAt(this.counts[kind]++, this.matrix.compose(this.place, this.turn, ONE));
    }
    this.kinds.forEach((mesh, k) => {
      mesh.count = this.counts[k];
      mesh.instanceMatrix.needsUpdate = true;
    });
  }

  /** Computes the direction of the needle at its point nearest to `place`. */
  private setTangentNear(line: Float32Array): void {
    let best = 0;
    let distance = Infinity;
    const last = line.length / 3 - 1;
    this.tangent.copy(AXIS);
    if (last < 1) return;
    for (let i = 0; i <= last; i++) {
      const d = (line[3 * i] - this.place.x) ** 2 + (line[3 * i + 1] - this.place.y) ** 2 + (line[3 * i + 2] - this.place.z) ** 2;
      if (d < distance) [best, distance] = [i, d];
    }
    this.from.fromArray(line, 3 * Math.max(0, best - 1));
    this.tangent.fromArray(line, 3 * Math.min(last, best + 1)).sub(this.from).normalize();
  }
}
