// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of one region, which each frame moves and colours.
import * as THREE from 'three';
import type { Frame, Region, ReportData } from '../data';
import { toLinear, viridis } from '../../../shared/colors';
import { applyColors, applyLook, type RegionLook } from '../../../shared/region_look';
import { densenRim } from '../../../shared/rim';

export class RegionMesh implements RegionLook {
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
  readonly centre: THREE.Vector3;  // [mm] LPS
  visible: boolean;
  opacity: number;
  private byDisplacement = false;
  private readonly nodes: Uint32Array;  // surface nodes of this region
  private readonly position: Float32Array;
  private readonly color: Float32Array;

  readonly box = new THREE.Box3();  // of the undeformed surface

  constructor(private readonly data: ReportData, readonly region: Region) {
    const local = new Map<number, number>();
    const index = new Uint32Array(region.triangles.length);
    region.triangles.forEach((node, i) => {
      let number = local.get(node);
      if (number === undefined) local.set(node, (number = local.size));
      index[i] = number;
    });
    this.nodes = Uint32Array.from(local.keys());
    this.position = new Float32Array(3 * this.nodes.length);
    this.color = new Float32Array(3 * this.nodes.length);
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    geometry.setAttribute('position', new THREE.BufferAttribute(this.position, 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(this.color, 3));
    const material = new THREE.MeshStandardMaterial({ color: region.color, roughness: 0.7, metalness: 0 });
    densenRim(material, region.background ? 0.06 : 0.6);
    this.object = new THREE.Mesh(geometry, material);
    const p = new THREE.Vector3();
    for (const node of this.nodes) this.box.expandByPoint(p.fromArray(data.surface.points_mm, 3 * node));
    this.centre = this.box.getCenter(new THREE.Vector3());
    this.object.frustumCulled = false;
    this.visible = true;
    this.opacity = region.opacity;
    this.applyLook();
  }

  applyLook(): void {
    applyLook(this, this.byDisplacement);
  }

  colorByDisplacement(on: boolean): void {
    this.byDisplacement = on;
    applyColors(this, on);
  }

  /**
   * Moves the nodes to their positions in a frame.
   * @param most displacement [mm] at the end of the colour scale
   * @param times factor by which the displacement is exaggerated
   */
  show(frame: Frame, most: number, times: number): void {
    const { surface: { points_mm: points }, displacement_scale_mm: scale } = this.data;
    this.nodes.forEach((node, i) => {
      let square = 0;
      for (let k = 0; k < 3; k++) {
        const u = frame.displacement[3 * node + k] * scale;
        this.position[3 * i + k] = points[3 * node + k] + times * u;
        square += u * u;
      }
      viridis(Math.sqrt(square) / most, this.color, 3 * i);
      for (let k = 0; k < 3; k++) this.color[3 * i + k] = toLinear(this.color[3 * i + k]);
    });
    const { geometry } = this.object;
    geometry.attributes.position.needsUpdate = true;
    geometry.attributes.color.needsUpdate = true;
    geometry.computeVertexNormals();
  }
}
