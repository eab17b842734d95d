// SPDX-License-Identifier: GPL-3.0-or-later
// Where the camera of a 3D view stands, in parallel projection.
import * as THREE from 'three';
import type { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

/**
 * Puts the camera in a standard place.
 * @param from direction from the anatomy to the observer, LPS
 * @param centre of what is shown [mm]
 * @param halfSize half height of the view at zoom 1 [mm]
 */
export function lookFrom(camera: THREE.OrthographicCamera, controls: OrbitControls, from: [number, number, number], centre: THREE.Vector3,
                         halfSize: number): void {
  const direction = new THREE.Vector3(...from).normalize();
  // OrbitControls cannot look exactly along its up axis: a hair beside it, with the front of the patient upwards.
  if (Math.abs(direction.z) > 0.99) direction.add(new THREE.Vector3(0, 1e-3 * Math.sign(direction.z) * -1, 0)).normalize();
  controls.target.copy(centre);
  camera.position.copy(centre).addScaledVector(direction, 12 * halfSize);
  camera.zoom = 1;
  camera.updateProjectionMatrix();
  controls.update();
}

/** Makes what the camera sees as wide as its picture. @param aspect width over height */
export function fitPicture(camera: THREE.OrthographicCamera, aspect: number, halfSize: number): void {
  camera.left = -halfSize * aspect;
  camera.right = halfSize * aspect;
  camera.top = halfSize;
  camera.bottom = -halfSize;
  camera.near = 0;
  camera.far = 40 * halfSize;
  camera.updateProjectionMatrix();
}
