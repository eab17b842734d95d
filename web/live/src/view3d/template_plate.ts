// SPDX-License-Identifier: GPL-3.0-or-later
// The guide template in 3D: a translucent plate with holes as rings; the needle's hole is marked.
import * as THREE from 'three';
import { holes, type Hole, type Template } from '../scene';

export class TemplatePlate {
  readonly object = new THREE.Group();
  private list: Hole[] = [];
  private rings: THREE.InstancedMesh | null = null;
  private current = '';  // name of the marked hole

  setTemplate(template: Template | null): void {
    for (const child of this.object.children as THREE.Mesh[]) {
      child.geometry.dispose();
      (child.material as THREE.Material).dispose();
    }
    this.object.clear();
    this.rings = null;
    if (!template) return;
    this.list = holes(template);
    const { pitch_mm: pitch, columns, rows, centre_mm: centre, z_mm: z } = template;
    const plate = new THREE.Mesh(
      new THREE.PlaneGeometry((columns.length + 1) * pitch, (rows.length + 1) * pitch),
      new THREE.MeshBasicMaterial({ color: '#aab2bd', transparent: true, opacity: 0.28, side: THREE.DoubleSide, depthWrite: false }));
    plate.position.set(centre[0], centre[1], z);
    plate.renderOrder = -50;
    const ring = new THREE.TorusGeometry(0.17 * pitch, 0.035 * pitch, 6, 18);
    this.rings = new THREE.InstancedMesh(ring, new THREE.MeshBasicMaterial(), this.list.length);
    this.rings.frustumCulled = false;
    const matrix = new THREE.Matrix4();
    this.list.forEach((hole, i) => this.rings?.setMatrixAt(i, matrix.makeTranslation(hole.x, hole.y, z)));
    this.object.add(plate, this.rings);
    const marked = this.current;
    this.current = ' ';
    this.mark(marked);
  }

  mark(hole: string): void {
    if (!this.rings || hole === this.current) return;
    this.current = hole;
    const color = new THREE.Color();
    this.list.forEach((h, i) => this.rings?.setColorAt(i, color.set(h.name === hole ? '#d55e00' : '#8a9099')));
    if (this.rings.instanceColor) this.rings.instanceColor.needsUpdate = true;
  }
}
