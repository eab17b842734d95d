// SPDX-License-Identifier: GPL-3.0-or-later
// A structure in the 3D view: a translucent surface, or points where no surface is known.
import * as THREE from 'three';
import { densenRim } from '../../../shared/rim';
import type { Structure } from './data';

const OPACITY = { target: 0.22, other: 0.4, background: 0.08, points: 0.9 };

export class StructureShape {
  readonly object: THREE.Object3D;
  readonly centre = new THREE.Vector3();  // [mm] LPS
  private readonly material: THREE.MeshStandardMaterial | THREE.PointsMaterial;
  readonly box: THREE.Box3;

  constructor(readonly structure: Structure) {
    const geometry = new THREE.BufferGeometry();
    const { surface, cloud_mm: cloud, color } = structure;
    geometry.setAttribute('position', new THREE.BufferAttribute(surface ? surface.points_mm : cloud, 3));
    if (surface) {
      geometry.setIndex(new THREE.BufferAttribute(surface.triangles, 1));
      geometry.computeVertexNormals();
      this.material = new THREE.MeshStandardMaterial({ color, roughness: 0.7, metalness: 0, transparent: true, depthWrite: false, side: THREE.FrontSide });
      densenRim(this.material, structure.background ? 0.06 : 0.6);
      this.object = new THREE.Mesh(geometry, this.material);
    } else {
      this.material = new THREE.PointsMaterial({ color, size: 2, sizeAttenuation: false, transparent: true, depthWrite: false });
      this.object = new THREE.Points(geometry, this.material);
    }
    geometry.computeBoundingBox();
    this.box = geometry.boundingBox ?? new THREE.Box3();
    if (!this.box.isEmpty()) this.box.getCenter(this.centre);
    this.object.frustumCulled = false;
    this.opacity = !surface ? OPACITY.points : structure.background ? OPACITY.background : structure.region === 'prostate' ? OPACITY.target : OPACITY.other;
    this.visible = !structure.background;
  }

  get opacity(): number {
    return this.material.opacity;
  }

  set opacity(value: number) {
    this.material.opacity = value;
  }

  get visible(): boolean {
    return this.object.visible;
  }

  set visible(value: boolean) {
    this.object.visible = value;
  }
}
