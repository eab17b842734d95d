// SPDX-License-Identifier: GPL-3.0-or-later
// The gland before the insertion: a wire frame of its undeformed surface, for comparison with its current position.
import * as THREE from 'three';
import { INK } from '../../../shared/plot_style';
import { glandTriangles, type Scene } from '../scene';

const OPACITY = 0.16;

export class GlandGhost {
  readonly object = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({
    color: INK, wireframe: true, transparent: true, opacity: OPACITY, depthWrite: false,
  }));

  constructor(clipping: THREE.Plane[]) {
    this.object.visible = false;
    this.object.frustumCulled = false;
    this.object.material.clippingPlanes = clipping;
  }

  setScene(scene: Scene): void {
    const { geometry } = this.object;
    geometry.setAttribute('position', new THREE.BufferAttribute(scene.points, 3));
    geometry.setIndex(new THREE.BufferAttribute(glandTriangles(scene), 1));
  }
}
