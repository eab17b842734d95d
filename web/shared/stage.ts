// SPDX-License-Identifier: GPL-3.0-or-later
// Scene, camera and light of a 3D view, in parallel projection. It is drawn only when something has changed.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { roundDown } from './colors';
import { OrientationCube } from './orientation_cube';
import { onRepaint } from './repaint';
import { VIEWS } from './views';

/** A surface through which one sees others. */
export interface Translucent {
  readonly object: THREE.Object3D;
  readonly box: THREE.Box3;        // [mm] LPS
  readonly centre: THREE.Vector3;  // of the box
}

interface Sorted {
  surface: Translucent;
  background: boolean;
  distance: number;
}

export class BaseStage {
  protected readonly scene = new THREE.Scene();
  protected readonly camera = new THREE.OrthographicCamera();
  protected readonly renderer: THREE.WebGLRenderer;
  protected readonly centre = new THREE.Vector3();
  protected halfSize = 60;  // [mm] half the height of the view at zoom 1
  private readonly controls: OrbitControls;
  private readonly cube = new OrientationCube();
  private readonly viewing = new THREE.Vector3();
  private translucent: Sorted[] = [];

  /**
   * Throws if the browser has no WebGL.
   * @param scaleBar receives length [mm] and width [CSS px] of the scale bar
   * @param ratio pixels of the picture per CSS px
   */
  constructor(private readonly box: HTMLElement, private readonly scaleBar: (mm: number, px: number) => void,
              parameters: THREE.WebGLRendererParameters, ratio = Math.min(devicePixelRatio, 2)) {
    this.renderer = new THREE.WebGLRenderer({ antialias: true, ...parameters });
    this.renderer.setPixelRatio(ratio);
    this.renderer.setClearColor('#ffffff');
    box.append(this.renderer.domElement);
    this.scene.add(new THREE.HemisphereLight('#ffffff', '#c8ccd2', 1.7));
    const lamp = new THREE.DirectionalLight('#ffffff', 1.6);
    lamp.position.set(-0.4, 0.7, 1);
    this.camera.add(lamp, lamp.target);
    this.camera.up.set(0, 0, 1);
    this.scene.add(this.camera);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.draw());
    new ResizeObserver(() => this.resize()).observe(box);
  }

  /** Puts the camera in a standard position. @param from direction from the anatomy to the observer, LPS */
  look(from: [number, number, number]): void {
    const { camera, controls } = this;
    const direction = new THREE.Vector3(...from).normalize();
    // OrbitControls cannot look exactly along its up axis, so the camera is slightly beside it; the patient's front is
    // up.
    if (Math.abs(direction.z) > 0.99) direction.add(new THREE.Vector3(0, 1e-3 * Math.sign(direction.z) * -1, 0)).normalize();
    controls.target.copy(this.centre);
    camera.position.copy(this.centre).addScaledVector(direction, 12 * this.halfSize);
    camera.zoom = 1;
    camera.updateProjectionMatrix();
    controls.update();
    this.draw();
  }

  zoom(factor: number): void {
    this.camera.zoom = Math.max(0.3, Math.min(12, this.camera.zoom * factor));
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Draws once before the next repaint, even if it is called several times. */
  readonly draw = onRepaint(() => this.render());

  /** The picture as it is now, as the address of a PNG; the drawing must be preserved. */
  still(): string {
    this.render();
    return this.renderer.domElement.toDataURL();
  }

  /** Surfaces whose order of drawing follows the view. @param isBackground whether a surface surrounds all others */
  protected setTranslucent<Kind extends Translucent>(surfaces: Kind[], isBackground: (surface: Kind) => boolean): void {
    this.translucent = surfaces.map((surface) => ({ surface, background: isBackground(surface), distance: 0 }));
  }

  /** Looks at a centre [mm LPS] from the first standard view. @param halfSize [mm] half the height of the view */
  protected frame(centre: THREE.Vector3, halfSize: number): void {
    this.centre.copy(centre);
    this.halfSize = halfSize;
    this.look(VIEWS[0].from);
    this.resize();
  }

  /** Half the height of the view [mm] at zoom 1 in a picture of this width divided by height. */
  protected halfHeight(_aspect: number): number {
    return this.halfSize;
  }

  protected get pixelsPerMm(): number {
    return (this.box.clientHeight * this.camera.zoom) / (this.camera.top - this.camera.bottom);
  }

  render(): void {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width === 0 || height === 0) return;
    this.renderer.setViewport(0, 0, width, height);
    this.sortTranslucent();
    this.renderer.render(this.scene, this.camera);
    this.cube.draw(this.renderer, this.camera, Math.round(Math.min(width, height) * 0.17));
    const mm = roundDown((0.16 * width) / this.pixelsPerMm);
    this.scaleBar(mm, mm * this.pixelsPerMm);
  }

  /** Sorts translucent surfaces: the farthest is drawn first, and one inside another before the outer one. */
  private sortTranslucent(): void {
    this.camera.getWorldDirection(this.viewing);
    for (const entry of this.translucent) entry.distance = this.distance(entry);
    this.translucent.sort((a, b) => b.distance - a.distance);
    this.translucent.forEach(({ surface }, order) => (surface.object.renderOrder = order));
  }

  private distance({ surface, background }: Sorted): number {
    if (background) return -Infinity;
    const { box, centre } = surface;
    const around = this.translucent.find((other) => !other.background && other.surface.box.containsBox(box) && !box.containsBox(other.surface.box));
    return around ? this.distance(around) + 1e-3 : centre.dot(this.viewing);
  }

  protected resize(): void {
    const { camera, renderer } = this;
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width === 0 || height === 0) return;
    const size = renderer.getSize(new THREE.Vector2());
    if (size.x !== width || size.y !== height) renderer.setSize(width, height);
    const half = this.halfHeight(width / height);
    [camera.left, camera.right, camera.top, camera.bottom] = [-half * (width / height), half * (width / height), half, -half];
    camera.near = 0;
    camera.far = 40 * half;
    camera.updateProjectionMatrix();
    this.render();
  }
}
