// SPDX-License-Identifier: GPL-3.0-or-later
// The shafts of needles that are in the tissue together, bent as they are with all of them in place.
import * as THREE from 'three';
import type { NeedleInPlace } from './data';

export const NEEDLE_COLOR = '#8d949e';
export const STABILISING_COLOR = '#3b4452';
const LEAST_RADIUS_MM = 0.5;  // thinner shafts could hardly be seen

export function needleShafts(needles: NeedleInPlace[], diameter_mm: number, color: string): THREE.Object3D {
  const material = new THREE.MeshStandardMaterial({ color, roughness: 0.45, metalness: 0.35 });
  const radius = Math.max(LEAST_RADIUS_MM, 0.5 * diameter_mm);
  const group = new THREE.Group();
  for (const { shaft_mm: shaft } of needles) {
    const line = new THREE.CatmullRomCurve3(shaft.map((x) => new THREE.Vector3(...x)));
    group.add(new THREE.Mesh(new THREE.TubeGeometry(line, 2 * shaft.length, radius, 10), material));
  }
  return group;
}
