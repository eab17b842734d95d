// SPDX-License-Identifier: GPL-3.0-or-later
// Scene, camera and light of the 3D view of a plan: structures and sources in parallel projection.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { fitPicture, lookFrom } from '../../../shared/camera';
import { roundDown } from '../../../shared/colors';
import { OrientationCube } from '../../../shared/orientation_cube';
import { VIEWS } from '../../../shared/views';
import type { DoseData } from './data';
import { sourceMarks } from './source_marks';
import { StructureShape } from './structure_shape';

export class DoseStage {
  readonly structures: StructureShape[];
  readonly sources: THREE.Object3D;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.OrthographicCamera();
  private readonly renderer: THREE.WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly cube = new OrientationCube();
  private readonly centre: THREE.Vector3;
  private readonly halfSize: number;  // [mm] half the height of the view at zoom 1
  private pending = false;

  /** Throws if the browser has no WebGL. @param scaleBar receives length [mm] and width [CSS px] of the scale bar */
  constructor(data: DoseData, private readonly box: HTMLElement, private readonly scaleBar: (mm: number, px: number) => void) {
    this.renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });  // needed for printing
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setClearColor('#ffffff');
    box.append(this.renderer.domElement);
    this.centre = new THREE.Vector3(...data.centre);
    this.halfSize = Math.max(0.95 * data.half, 10);
    this.structures = data.structures.map((s) => new StructureShape(s));
    this.sources = sourceMarks(data.sources);
    this.scene.add(...this.structures.map((s) => s.object), this.sources);
    this.scene.add(new THREE.HemisphereLight('#ffffff', '#c8ccd2', 1.7));
    const lamp = new THREE.DirectionalLight('#ffffff', 1.6);
    lamp.position.set(-0.4, 0.7, 1);
    this.camera.add(lamp, lamp.target);
    this.scene.add(this.camera);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.draw());
    this.look(VIEWS[0].from);
    new ResizeObserver(() => this.resize()).observe(box);
    this.resize();
  }

  /** Adds something else to the picture. */
  add(object: THREE.Object3D): void {
    this.scene.add(object);
    this.draw();
  }

  /** Puts the camera in a standard position. @param from direction from the anatomy to the observer, LPS */
  look(from: [number, number, number]): void {
    lookFrom(this.camera, this.controls, from, this.centre, this.halfSize);
    this.draw();
  }

  /** Draws once before the next repaint, even if it is called several times. */
  draw(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => this.render());
  }

  /** The picture as it is now, as the address of a PNG. */
  still(): string {
    this.render();
    return this.renderer.domElement.toDataURL();
  }

  private render(): void {
    this.pending = false;
    const { clientWidth: width, clientHeight: height } = this.box;
    this.sortStructures();
    this.renderer.setViewport(0, 0, width, height);
    this.renderer.render(this.scene, this.camera);
    this.cube.draw(this.renderer, this.camera, Math.round(Math.min(width, height) * 0.17));
    const pixelsPerMm = (height * this.camera.zoom) / (2 * this.halfSize);
    const mm = roundDown((0.16 * width) / pixelsPerMm);
    this.scaleBar(mm, mm * pixelsPerMm);
  }

  /** Sorts translucent surfaces: the farthest is drawn first, and a structure within another before the outer one. */
  private sortStructures(): void {
    const view = this.camera.getWorldDirection(new THREE.Vector3());
    const distance = (shape: StructureShape): number => {
      const around = this.structures.find((other) => other.holds(shape));
      return around ? distance(around) + 1e-3 : shape.centre.dot(view);
    };
    [...this.structures]
      .map((shape) => ({ shape, distance: distance(shape) }))
      .sort((a, b) => b.distance - a.distance)
      .forEach(({ shape }, order) => (shape.object.renderOrder = order + 1));
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    fitPicture(this.camera, width / height, this.halfSize * Math.max(1, height / width));
    this.draw();
  }
}
