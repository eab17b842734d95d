// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of one region. Its buffers are allocated once; each frame writes positions, normals and, if colours show
// the displacement, colours.
import * as THREE from 'three';
import { toLinear, viridis } from '../../../shared/colors';
import { applyColors, applyLook, isShown, type RegionLook } from '../../../shared/region_look';
import { densenRim } from '../../../shared/rim';
import type { Anatomy } from '../anatomy';
import { regionTriangles, type Region } from '../scene';

export class RegionSurface implements RegionLook {
  readonly region: Region;
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
  readonly centre = new THREE.Vector3();
  visible = true;
  opacity: number;
  readonly box = new THREE.Box3();  // of the undeformed surface
  private readonly nodes: Uint32Array;      // node numbers of the scene
  private readonly index: Uint32Array;      // corners of the triangles as indices of `nodes`
  private readonly position: THREE.BufferAttribute;
  private readonly normal: THREE.BufferAttribute;
  private readonly color: THREE.BufferAttribute;
  private byDisplacement = false;

  constructor(private readonly anatomy: Anatomy, readonly number: number, clipping: THREE.Plane[]) {
    this.region = anatomy.scene.regions[number];
    const triangles = regionTriangles(anatomy.scene, number);
    const local = new Map<number, number>();
    this.index = triangles.map((node) => {
      const known = local.get(node);
      if (known !== undefined) return known;
      local.set(node, local.size);
      return local.size - 1;
    });
    this.nodes = Uint32Array.from(local.keys());
    const attribute = () => new THREE.BufferAttribute(new Float32Array(3 * this.nodes.length), 3).setUsage(THREE.DynamicDrawUsage);
    this.position = attribute();
    this.normal = attribute();
    this.color = attribute();
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(this.index, 1));
    geometry.setAttribute('position', this.position);
    geometry.setAttribute('normal', this.normal);
    geometry.setAttribute('color', this.color);
    const material = new THREE.MeshStandardMaterial({ color: this.region.color, roughness: 0.7, metalness: 0 });
    material.clippingPlanes = clipping;
    densenRim(material, this.region.background ? 0.06 : 0.6);
    this.object = new THREE.Mesh(geometry, material);
    this.object.frustumCulled = false;
    const p = new THREE.Vector3();
    for (const node of this.nodes) this.box.expandByPoint(p.fromArray(anatomy.scene.points, 3 * node));
    this.box.getCenter(this.centre);
    this.opacity = this.region.opacity;
    this.applyLook();
  }

  get shown(): boolean {
    return isShown(this);
  }

  copyLook(other: RegionSurface): void {
    this.visible = other.visible;
    this.opacity = other.opacity;
    this.applyLook();
  }

  applyLook(): void {
    applyLook(this, this.byDisplacement);
  }

  colorByDisplacement(on: boolean): void {
    this.byDisplacement = on;
    applyColors(this, on);
  }

  /** Writes the buffers. @param most displacement [mm] at the end of the colour scale */
  update(most: number): void {
    if (!this.shown) return;
    const { position } = this.anatomy;
    const to = this.position.array;
    for (let i = 0; i < this.nodes.length; i++) {
      const from = 3 * this.nodes[i];
      to[3 * i] = position[from];
      to[3 * i + 1] = position[from + 1];
      to[3 * i + 2] = position[from + 2];
    }
    this.position.needsUpdate = true;
    this.updateNormals();
    if (this.byDisplacement) this.updateColors(most);
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }

  /** Sums the normals of the adjacent triangles, weighted with their areas. The shader normalises them. */
  private updateNormals(): void {
    const p = this.position.array;
    const n = this.normal.array;
    n.fill(0);
    for (let t = 0; t < this.index.length; t += 3) {
      const [a, b, c] = [3 * this.index[t], 3 * this.index[t + 1], 3 * this.index[t + 2]];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      n[a] += x; n[a + 1] += y; n[a + 2] += z;
      n[b] += x; n[b + 1] += y; n[b + 2] += z;
      n[c] += x; n[c + 1] += y; n[c + 2] += z;
    }
    this.normal.needsUpdate = true;
  }

  private updateColors(most: number): void {
    const c = this.color.array as Float32Array;
    for (let i = 0; i < this.nodes.length; i++) {
      viridis(this.anatomy.displacement[this.nodes[i]] / most, c, 3 * i);
      for (let k = 0; k < 3; k++) c[3 * i + k] = toLinear(c[3 * i + k]);
    }
    this.color.needsUpdate = true;
  }
}
