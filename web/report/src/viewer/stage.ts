// SPDX-License-Identifier: GPL-3.0-or-later
// The interactive view: anatomy, needle and contacts.
import * as THREE from 'three';
import type { Frame, ReportData } from '../data';
import { ContactMarks } from '../../../shared/contact_marks';
import { NeedleMesh } from '../../../shared/needle_mesh';
import { BaseStage } from '../../../shared/stage';
import { RegionMesh } from './region_mesh';

export class Stage extends BaseStage {
  readonly regions: RegionMesh[];
  readonly contacts: ContactMarks;
  private readonly needle: NeedleMesh;

  /** @param box, scaleBar as for BaseStage */
  constructor(data: ReportData, box: HTMLElement, scaleBar: (mm: number, px: number) => void) {
    super(box, scaleBar, { preserveDrawingBuffer: true });  // needed for printing
    this.regions = data.surface.regions.map((r) => new RegionMesh(data, r));
    this.setTranslucent(this.regions, ({ region }) => region.background);
    this.needle = new NeedleMesh(data.needle_diameter_mm);
    this.contacts = new ContactMarks(data.needle_diameter_mm);
    this.scene.add(...this.regions.map((r) => r.object), this.needle.object, this.contacts.object);
    this.frameOrgans(data);
  }

  /** Shows a frame. @param most displacement [mm] at the end of the colour scale @param times factor of exaggeration */
  show(frame: Frame, most: number, times: number): void {
    for (const region of this.regions) region.show(frame, most, times);
    this.needle.show(frame.needle_mm);
    this.contacts.show(frame.needle_mm, frame.contacts);
    this.draw();
  }

  /** Looks at the organs, the entry and the deepest tip. */
  private frameOrgans(data: ReportData): void {
    const box = new THREE.Box3();
    const p = new THREE.Vector3();
    const foreground = data.surface.regions.filter((r) => !r.background);
    for (const region of foreground.length > 0 ? foreground : data.surface.regions) {
      for (const node of region.triangles) box.expandByPoint(p.fromArray(data.surface.points_mm, 3 * node));
    }
    const entry = new THREE.Vector3(...data.entry_mm);
    box.expandByPoint(entry);
    box.expandByPoint(p.copy(entry).addScaledVector(new THREE.Vector3(...data.direction), -12));
    for (const frame of data.frames) {
      if (frame.needle_mm.length >= 3 && frame.depth_mm > 0) box.expandByPoint(p.fromArray(frame.needle_mm, frame.needle_mm.length - 3));
    }
    const size = box.getSize(new THREE.Vector3());
    this.frame(box.getCenter(p), 0.58 * Math.max(size.z, 0.8 * Math.hypot(size.x, size.y)));
  }
}
