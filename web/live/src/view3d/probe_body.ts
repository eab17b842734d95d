// SPDX-License-Identifier: GPL-3.0-or-later
// The ultrasound probe in 3D: a rod with a rounded end, from its last picture on.
import * as THREE from 'three';
import type { ProbeState } from '../imaging/image';

const LENGTH_MM = 150;
const UP = new THREE.Vector3(0, 1, 0);

export class ProbeBody {
  readonly object: THREE.Mesh;
  private size = '';
  private readonly axis = new THREE.Vector3();

  constructor() {
    this.object = new THREE.Mesh(new THREE.BufferGeometry(),
      new THREE.MeshStandardMaterial({ color: '#8d99a6', roughness: 0.4, transparent: true, opacity: 0.75 }));
    this.object.visible = false;
  }

  /** @param probe null: there is none */
  show(probe: ProbeState | null): void {
    this.object.visible = probe !== null;
    if (!probe) return;
    const radius = probe.diameter_mm / 2 + probe.balloon_mm;
    const size = radius.toFixed(2);
    if (size !== this.size) {
      this.size = size;
      this.object.geometry.dispose();
      this.object.geometry = new THREE.CapsuleGeometry(radius, LENGTH_MM, 12, 32);
    }
    this.axis.set(...probe.axis);
    this.object.quaternion.setFromUnitVectors(UP, this.axis);
    this.object.position.set(...probe.tip_mm).addScaledVector(this.axis, -(radius + LENGTH_MM / 2));
  }
}
