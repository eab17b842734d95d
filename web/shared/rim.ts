// SPDX-License-Identifier: GPL-3.0-or-later
import type * as THREE from 'three';

/**
 * Makes a translucent surface more opaque at its rim, where one looks along it, so that shapes behind others are
 * visible.
 */
export function densenRim(material: THREE.MeshStandardMaterial, strength: number): void {
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      '#include <opaque_fragment>',
      `float rim = pow(1.0 - abs(dot(normalize(vViewPosition), normal)), 2.5);
       diffuseColor.a = mix(diffuseColor.a, 1.0, ${strength.toFixed(2)} * rim);
       #include <opaque_fragment>`);
  };
}
