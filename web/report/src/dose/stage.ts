// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view of a plan: structures and sources.
import * as THREE from 'three';
import { BaseStage } from '../../../shared/stage';
import type { DoseData } from './data';
import { sourceMarks } from './source_marks';
import { StructureShape } from './structure_shape';

export class DoseStage extends BaseStage {
  readonly structures: StructureShape[];
  readonly sources: THREE.Object3D;

  /** @param box, scaleBar as for BaseStage */
  constructor(data: DoseData, box: HTMLElement, scaleBar: (mm: number, px: number) => void) {
    super(box, scaleBar, { preserveDrawingBuffer: true });  // needed for printing
    this.structures = data.structures.map((s) => new StructureShape(s));
    this.setTranslucent(this.structures, ({ structure }) => structure.background);
    this.sources = sourceMarks(data.sources);
    this.scene.add(...this.structures.map((s) => s.object), this.sources);
    this.frame(new THREE.Vector3(...data.centre_mm), Math.max(0.95 * data.half_mm, 10));
  }

  /** Adds something else to the picture. */
  add(object: THREE.Object3D): void {
    this.scene.add(object);
    this.draw();
  }

  protected override halfHeight(aspect: number): number {
    return this.halfSize * Math.max(1, 1 / aspect);
  }
}
