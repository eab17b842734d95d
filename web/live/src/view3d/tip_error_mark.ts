// SPDX-License-Identifier: GPL-3.0-or-later
// The tip error in 3D: a line from a cross at the planned place of the tip to a ring at its place in the tissue, both
// in the undeformed patient. They are drawn over everything else, because the needle would hide them.
import * as THREE from 'three';
import { lineScale } from '../../../shared/plot_style';
import { makeEnds, tipErrorEnds } from '../tip_error';
import { drawCross, drawRing, LINE_COLORS, LINE_WIDTHS_PX } from '../tip_error_shapes';
import type { Frame } from '../wire';

const SIZE_MM = 3.4;
const LEAST_PX = 20;
const LAST = 1000;  // render order after all translucent surfaces
const UP = new THREE.Vector3(0, 1, 0);
const PICTURE_PX = 96;

/** Makes a mark that always faces the observer. */
function sprite(shape: typeof drawCross, order: number): THREE.Sprite {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = PICTURE_PX;
  shape(canvas.getContext('2d') as CanvasRenderingContext2D, [PICTURE_PX / 2, PICTURE_PX / 2], 0.36 * PICTURE_PX);
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  const mark = new THREE.Sprite(new THREE.SpriteMaterial({ map, depthTest: false, depthWrite: false }));
  mark.renderOrder = order;
  return mark;
}

export class TipErrorMark {
  readonly object = new THREE.Group();
  needleLength = 200;  // [mm]
  private readonly lines = LINE_COLORS.map((color, i) => {
    const material = new THREE.MeshBasicMaterial({ color, transparent: true, depthTest: false, depthWrite: false });
    const line = new THREE.Mesh(new THREE.CylinderGeometry(0.5, 0.5, 1, 8), material);
    line.renderOrder = LAST + i;
    return line;
  });
  private readonly cross = sprite(drawCross, LAST + 3);
  private readonly ring = sprite(drawRing, LAST + 2);
  private readonly ends = makeEnds();
  private readonly way = new THREE.Vector3();

  constructor() {
    this.object.add(...this.lines, this.cross, this.ring);
    this.setThere(false);
  }

  show(frame: Frame): void {
    const there = tipErrorEnds(frame, this.needleLength, this.ends);
    this.setThere(there);
    if (!there) return;
    this.cross.position.fromArray(this.ends.planned);
    this.ring.position.fromArray(this.ends.reached);
    this.way.subVectors(this.ring.position, this.cross.position);
    for (const line of this.lines) {
      line.position.addVectors(this.cross.position, this.ring.position).multiplyScalar(0.5);
      line.scale.y = this.way.length();
    }
    this.way.normalize();
    for (const line of this.lines) line.quaternion.setFromUnitVectors(UP, this.way);
  }

  /** Keeps the marks large enough to be seen at every zoom. @param ratio pixels of the picture per CSS pixel */
  fit(pixelsPerMm: number, ratio: number): void {
    const scale = lineScale();
    const size = Math.max(SIZE_MM, (scale * LEAST_PX) / pixelsPerMm);
    for (const mark of [this.cross, this.ring]) mark.scale.set(size, size, 1);
    this.lines.forEach((line, i) => (line.scale.x = line.scale.z = (scale * LINE_WIDTHS_PX[i]) / Math.min(1, ratio) / pixelsPerMm));
  }

  private setThere(there: boolean): void {
    for (const part of this.object.children) part.visible = there;
  }
}
