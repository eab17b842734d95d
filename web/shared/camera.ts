// SPDX-License-Identifier: GPL-3.0-or-later
// Positions of the camera of a 3D view in parallel projection.
import * as THREE from 'three';
import type { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

/**
 * Puts the camera in a standard position.
 * @param from direction from the anatomy to the observer, LPS
 * @param centre [mm] centre of the view
 * @param halfSize [mm] half the height of the view at zoom 1
 */
export function lookFrom(camera: THREE.OrthographicCamera, controls: OrbitControls, from: [number, number, number], centre: THREE.Vector3,
                         halfSize: number): void {
  const direction = new THREE.Vector3(...from).normalize();
  // OrbitControls cannot look exactly along its up axis, so the camera is slightly beside it; the patient's front is
  // up.
  if (Math.abs(direction.z) > 0.99) direction.add(new THREE.Vector3(0, 1e-3 * Math.sign(direction.z) * -1, 0)).normalize();
  controls.target.copy(centre);
  camera.position.copy(centre).addScaledVector(direction, 12 * halfSize);
  camera.zoom = 1;
  camera.updateProjectionMatrix();
  controls.update();
}

/** Fits the camera's field of view to its picture. @param aspect width divided by height */
export function fitPicture(camera: THREE.OrthographicCamera, aspect: number, halfSize: number): void {
  camera.left = -halfSize * aspect;
  camera.right = halfSize * aspect;
  camera.top = halfSize;
  camera.bottom = -halfSize;
  camera.near = 0;
  camera.far = 40 * halfSize;
  camera.updateProjectionMatrix();
}
