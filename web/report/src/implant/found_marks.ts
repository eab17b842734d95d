// SPDX-License-Identifier: GPL-3.0-or-later
// Marks in the 3D view where seeds were found on images.
import * as THREE from 'three';
import type { Found } from './data';

export const FOUND_COLOR = '#c44601';
const MARK_MM = 0.85;  // from the centre of a mark to its corners

/** A mark for each seed that was found, in front of everything else as the arrows are. */
export function foundMarks({ seeds, not_dropped: others }: Found): THREE.Object3D {
  const places = [...seeds, ...others];
  const material = new THREE.MeshStandardMaterial({ color: FOUND_COLOR, roughness: 0.6, depthTest: false, transparent: true });
  const marks = new THREE.InstancedMesh(new THREE.OctahedronGeometry(MARK_MM), material, places.length);
  places.forEach(({ found_mm: place }, k) => marks.setMatrixAt(k, new THREE.Matrix4().setPosition(...place)));
  marks.frustumCulled = false;
  marks.renderOrder = 1000;
  return marks;
}
