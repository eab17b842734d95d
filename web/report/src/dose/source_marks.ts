// SPDX-License-Identifier: GPL-3.0-or-later
// The sources in the 3D view: seeds as capsules of their true size along their axes; places where a source dwells as
// balls whose volume goes with the time, joined by a line for each needle.
import * as THREE from 'three';
import type { Sources } from './data';

const SEED_COLOR = '#3b4452';
const NEEDLE_COLOR = '#8a9099';

function seeds(sources: Sources): THREE.InstancedMesh {
  const radius = Math.max(sources.diameter_mm, 0.5) / 2;
  const shape = new THREE.CapsuleGeometry(radius, Math.max(sources.length_mm - 2 * radius, 0), 6, 14);
  const mesh = new THREE.InstancedMesh(shape, new THREE.MeshStandardMaterial({ color: SEED_COLOR, roughness: 0.35, metalness: 0.5 }), sources.needles.length);
  const along = new THREE.Vector3(0, 1, 0);  // the capsule's own axis
  const one = new THREE.Vector3(1, 1, 1);
  for (let s = 0; s < sources.needles.length; s++) {
    const turn = new THREE.Quaternion().setFromUnitVectors(along, new THREE.Vector3().fromArray(sources.axes, 3 * s).normalize());
    mesh.setMatrixAt(s, new THREE.Matrix4().compose(new THREE.Vector3().fromArray(sources.places_mm, 3 * s), turn, one));
  }
  mesh.frustumCulled = false;
  return mesh;
}

function dwells(sources: Sources): THREE.Group {
  const group = new THREE.Group();
  const longest = Math.max(...sources.dwell_s, 1e-9);
  const balls = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 16, 12), new THREE.MeshStandardMaterial({ color: SEED_COLOR, roughness: 0.4 }), sources.needles.length);
  const needles = new Map<string, THREE.Vector3[]>();
  for (let s = 0; s < sources.needles.length; s++) {
    const at = new THREE.Vector3().fromArray(sources.places_mm, 3 * s);
    const radius = 0.35 + 1.1 * Math.cbrt(sources.dwell_s[s] / longest);
    balls.setMatrixAt(s, new THREE.Matrix4().makeScale(radius, radius, radius).setPosition(at));
    if (!sources.needles[s]) continue;
    needles.set(sources.needles[s], [...(needles.get(sources.needles[s]) ?? []), at]);
  }
  balls.frustumCulled = false;
  group.add(balls);
  for (const places of needles.values()) {
    group.add(new THREE.Line(new THREE.BufferGeometry().setFromPoints(places), new THREE.LineBasicMaterial({ color: NEEDLE_COLOR })));
  }
  return group;
}

export function sourceMarks(sources: Sources): THREE.Object3D {
  return sources.temporary ? dwells(sources) : seeds(sources);
}
