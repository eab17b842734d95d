// SPDX-License-Identifier: GPL-3.0-or-later
// A cube in the corner with the patient's directions on its faces. It turns with the camera.
import * as THREE from 'three';

function face(letter: string): THREE.CanvasTexture {
  const size = 128;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const context = canvas.getContext('2d') as CanvasRenderingContext2D;
  context.fillStyle = '#f4f5f6';
  context.fillRect(0, 0, size, size);
  context.strokeStyle = '#23262b';
  context.lineWidth = 5;
  context.strokeRect(0, 0, size, size);
  context.fillStyle = '#23262b';
  context.font = `600 ${size * 0.66}px system-ui, sans-serif`;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillText(letter, size / 2, size * 0.54);
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  return texture;
}

export class OrientationCube {
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 10);

  constructor() {
    // Faces in the order +x −x +y −y +z −z (LPS). Each letter is upright when the patient's head is up.
    const turns: [string, THREE.Euler, THREE.Vector3][] = [
      ['L', new THREE.Euler(Math.PI / 2, Math.PI / 2, 0, 'XYZ'), new THREE.Vector3(1, 0, 0)],
      ['R', new THREE.Euler(Math.PI / 2, -Math.PI / 2, 0, 'XYZ'), new THREE.Vector3(-1, 0, 0)],
      ['P', new THREE.Euler(-Math.PI / 2, Math.PI, 0, 'XYZ'), new THREE.Vector3(0, 1, 0)],
      ['A', new THREE.Euler(Math.PI / 2, 0, 0, 'XYZ'), new THREE.Vector3(0, -1, 0)],
      ['S', new THREE.Euler(0, 0, 0, 'XYZ'), new THREE.Vector3(0, 0, 1)],
      ['I', new THREE.Euler(Math.PI, 0, 0, 'XYZ'), new THREE.Vector3(0, 0, -1)],
    ];
    for (const [letter, turn, normal] of turns) {
      const square = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), new THREE.MeshBasicMaterial({ map: face(letter) }));
      square.position.copy(normal).multiplyScalar(0.5);
      square.setRotationFromEuler(turn);
      this.scene.add(square);
    }
  }

  /** Draws the cube over the lower left corner of the renderer's picture. @param size [CSS px] */
  draw(renderer: THREE.WebGLRenderer, main: THREE.Camera, size: number): void {
    this.camera.position.set(0, 0, 3).applyQuaternion(main.quaternion);
    this.camera.quaternion.copy(main.quaternion);
    renderer.autoClear = false;
    renderer.clearDepth();
    renderer.setScissorTest(true);
    renderer.setScissor(0, 0, size, size);
    renderer.setViewport(0, 0, size, size);
    renderer.render(this.scene, this.camera);
    renderer.setScissorTest(false);
    renderer.autoClear = true;
  }
}
