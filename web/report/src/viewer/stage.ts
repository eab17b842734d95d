// SPDX-License-Identifier: GPL-3.0-or-later
// Scene, camera and light of the interactive view: anatomy, needle and contacts in parallel projection.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Frame, ReportData } from '../data';
import { fitPicture, lookFrom } from '../../../shared/camera';
import { roundDown } from '../../../shared/colors';
import { ContactMarks } from '../../../shared/contact_marks';
import { NeedleMesh } from '../../../shared/needle_mesh';
import { OrientationCube } from '../../../shared/orientation_cube';
import { VIEWS } from '../../../shared/views';
import { RegionMesh } from './region_mesh';

export class Stage {
  readonly regions: RegionMesh[];
  readonly contacts: ContactMarks;
  private readonly needle: NeedleMesh;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.OrthographicCamera();
  private readonly renderer: THREE.WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly cube = new OrientationCube();
  private readonly centre = new THREE.Vector3();
  private halfSize = 1;  // [mm] half the height of the view at zoom 1
  private pending = false;

  /** Throws if the browser has no WebGL. @param scaleBar receives length [mm] and width [CSS px] of the scale bar */
  constructor(private readonly data: ReportData, private readonly box: HTMLElement,
              private readonly scaleBar: (mm: number, px: number) => void) {
    this.renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });  // needed for printing
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setClearColor('#ffffff');
    box.append(this.renderer.domElement);

    this.regions = data.regions.map((r) => new RegionMesh(data, r));
    this.needle = new NeedleMesh(data.needleDiameter);
    this.contacts = new ContactMarks(data.needleDiameter);
    this.scene.add(...this.regions.map((r) => r.object), this.needle.object, this.contacts.object);
    this.scene.add(new THREE.HemisphereLight('#ffffff', '#c8ccd2', 1.7));
    const lamp = new THREE.DirectionalLight('#ffffff', 1.6);
    lamp.position.set(-0.4, 0.7, 1);
    this.camera.add(lamp, lamp.target);
    this.scene.add(this.camera);

    this.frameOrgans();
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.draw());
    this.look(VIEWS[0].from);
    new ResizeObserver(() => this.resize()).observe(box);
    this.resize();
  }

  /** Shows a frame. @param most displacement [mm] at the end of the colour scale @param times factor of exaggeration */
  show(frame: Frame, most: number, times: number): void {
    for (const region of this.regions) region.show(frame, most, times);
    this.needle.show(frame.needle);
    this.contacts.show(frame.needle, frame.contacts);
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
    this.renderer.setViewport(0, 0, width, height);
    this.sortRegions();
    this.renderer.render(this.scene, this.camera);
    this.cube.draw(this.renderer, this.camera, Math.round(Math.min(width, height) * 0.17));
    this.updateScaleBar(height);
  }

  /** Sorts translucent surfaces: the farthest is drawn first, and a region inside another before the outer region. */
  private sortRegions(): void {
    const view = this.camera.getWorldDirection(new THREE.Vector3());
    const distance = (mesh: RegionMesh): number => {
      if (mesh.region.background) return -Infinity;
      const around = this.regions.find((other) => !other.region.background && other.holds(mesh));
      return around ? distance(around) + 1e-3 : mesh.centre.dot(view);
    };
    [...this.regions]
      .map((mesh) => ({ mesh, distance: distance(mesh) }))
      .sort((a, b) => b.distance - a.distance)
      .forEach(({ mesh }, order) => (mesh.object.renderOrder = order));
  }

  private updateScaleBar(height: number): void {
    const pixelsPerMm = (height * this.camera.zoom) / (2 * this.halfSize);
    const mm = roundDown((0.16 * this.box.clientWidth) / pixelsPerMm);
    this.scaleBar(mm, mm * pixelsPerMm);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    fitPicture(this.camera, width / height, this.halfSize);
    this.draw();
  }

  /** Computes centre and size of the view from the organs, the entry and the deepest tip. */
  private frameOrgans(): void {
    const box = new THREE.Box3();
    const p = new THREE.Vector3();
    const foreground = this.data.regions.filter((r) => !r.background);
    for (const region of foreground.length > 0 ? foreground : this.data.regions) {
      for (const node of region.triangles) box.expandByPoint(p.fromArray(this.data.points, 3 * node));
    }
    const entry = new THREE.Vector3(...this.data.entry);
    box.expandByPoint(entry);
    box.expandByPoint(p.copy(entry).addScaledVector(new THREE.Vector3(...this.data.direction), -12));
    for (const frame of this.data.frames) {
      if (frame.needle.length >= 3 && frame.depth > 0) box.expandByPoint(p.fromArray(frame.needle, frame.needle.length - 3));
    }
    box.getCenter(this.centre);
    const size = box.getSize(p);
    this.halfSize = 0.58 * Math.max(size.z, 0.8 * Math.hypot(size.x, size.y));
  }
}
