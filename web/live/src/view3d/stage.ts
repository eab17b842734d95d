// SPDX-License-Identifier: GPL-3.0-or-later
// Scene, camera and light of the 3D view, in parallel projection. It is drawn only when something has changed.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { fitPicture, lookFrom } from '../../../shared/camera';
import { roundDown } from '../../../shared/colors';
import { ContactMarks } from '../../../shared/contact_marks';
import { NeedleMesh } from '../../../shared/needle_mesh';
import { OrientationCube } from '../../../shared/orientation_cube';
import { VIEWS } from '../../../shared/views';
import type { Anatomy } from '../anatomy';
import { onRepaint } from '../repaint';
import { organBounds } from '../scene';
import type { Frame } from '../wire';
import { CutPlane } from './cut_plane';
import { GlandGhost } from './gland_ghost';
import { Pace } from './pace';
import { RegionSurface } from './region_surface';
import { ProbeBody } from './probe_body';
import { SeedBodies } from './seed_bodies';
import { TemplatePlate } from './template_plate';
import { TipErrorMark } from './tip_error_mark';

export class Stage {
  surfaces: RegionSurface[] = [];
  contacts = new ContactMarks(1.27);
  readonly cut = new CutPlane();
  readonly template = new TemplatePlate();
  readonly ghost = new GlandGhost(this.cut.clipping);
  readonly tipError = new TipErrorMark();
  readonly seeds = new SeedBodies();
  readonly probe = new ProbeBody();
  readonly canvas: HTMLCanvasElement;
  onFirstPicture: () => void = () => {};
  private needle = new NeedleMesh(1.27);
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.OrthographicCamera();
  private readonly renderer: THREE.WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly cube = new OrientationCube();
  private readonly centre = new THREE.Vector3();
  private readonly viewing = new THREE.Vector3();
  private sorted: { surface: RegionSurface; distance: number }[] = [];
  private readonly pace = new Pace(Math.min(devicePixelRatio, 2));
  private halfSize = 60;  // [mm] half the height of the view at zoom 1
  private drawn = false;
  private compiled = false;  // shaders are compiled in the background, because waiting for them would block the page

  /** Throws if the browser has no WebGL. @param scaleBar receives length [mm] and width [CSS px] of the scale bar */
  constructor(private readonly box: HTMLElement, private readonly scaleBar: (mm: number, px: number) => void) {
    this.renderer = new THREE.WebGLRenderer({ antialias: true, stencil: true });
    this.renderer.setPixelRatio(this.pace.ratio);
    this.renderer.setClearColor('#ffffff');
    this.renderer.localClippingEnabled = true;
    this.canvas = this.renderer.domElement;
    box.append(this.canvas);
    this.scene.add(this.needle.object, this.contacts.object, this.cut.object, this.template.object, this.ghost.object, this.tipError.object, this.seeds.object, this.probe.object);
    this.scene.add(new THREE.HemisphereLight('#ffffff', '#c8ccd2', 1.7));
    const lamp = new THREE.DirectionalLight('#ffffff', 1.6);
    lamp.position.set(-0.4, 0.7, 1);
    this.camera.add(lamp, lamp.target);
    this.camera.up.set(0, 0, 1);
    this.scene.add(this.camera);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.look(VIEWS[0].from);
    new ResizeObserver(() => this.resize()).observe(box);
    this.resize();
  }

  /** Shows a patient. @param again whether the same patient was shown before; then its appearance and the view stay */
  setAnatomy(anatomy: Anatomy, again: boolean): void {
    const before = this.surfaces;
    for (const surface of this.surfaces) {
      this.scene.remove(surface.object);
      surface.dispose();
    }
    this.scene.remove(this.needle.object, this.contacts.object);
    const { scene } = anatomy;
    this.needle = new NeedleMesh(scene.needle.diameter_mm);
    const contactsShown = this.contacts.object.visible;  // the check box applies to every patient
    this.contacts = new ContactMarks(scene.needle.diameter_mm);
    this.contacts.object.visible = contactsShown;
    this.surfaces = scene.regions.map((_, i) => new RegionSurface(anatomy, i, this.cut.clipping));
    if (again) this.surfaces.forEach((surface, i) => surface.copyLook(before[i]));
    this.sorted = this.surfaces.map((surface) => ({ surface, distance: 0 }));
    this.scene.add(this.needle.object, this.contacts.object, ...this.surfaces.map((s) => s.object));
    this.frameOrgans(anatomy);
    this.cut.setSurfaces(this.surfaces, 20 * this.halfSize);
    this.template.setTemplate(scene.template);
    this.ghost.setScene(scene);
    this.tipError.needleLength = scene.needle.length_mm;
    if (!again) this.look(VIEWS[0].from);
    this.resize();
    void this.renderer.compileAsync(this.scene, this.camera).then(() => {
      this.compiled = true;
      this.draw();
    });
  }

  /** Updates the surfaces. @param most displacement [mm] at the end of the colour scale */
  showTissue(most: number): void {
    for (const surface of this.surfaces) surface.update(most);
    this.draw();
  }

  showNeedle(frame: Frame): void {
    this.needle.show(frame.line);
    this.contacts.show(frame.line, frame.contacts);
    this.tipError.show(frame);
    this.draw();
  }

  /** Puts the camera in a standard position. @param from direction from the anatomy to the observer, LPS */
  look(from: [number, number, number]): void {
    lookFrom(this.camera, this.controls, from, this.centre, this.halfSize);
    this.draw();
  }

  zoom(factor: number): void {
    this.camera.zoom = Math.max(0.3, Math.min(12, this.camera.zoom * factor));
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  readonly draw = onRepaint(() => {
    if (this.pace.tick(performance.now())) this.renderer.setPixelRatio(this.pace.ratio);
    this.render();
  });

  render(): void {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width === 0 || height === 0 || !this.compiled) return;
    this.renderer.setViewport(0, 0, width, height);
    this.sortSurfaces();
    const pixelsPerMm = (height * this.camera.zoom) / (2 * this.halfSize);
    this.tipError.fit(pixelsPerMm, this.pace.ratio);
    this.renderer.render(this.scene, this.camera);
    if (!this.drawn) {
      this.drawn = true;
      performance.mark('3D view');  // for measuring how long the page takes to open
      this.onFirstPicture();
    }
    this.cube.draw(this.renderer, this.camera, Math.round(Math.min(width, height) * 0.17));
    const mm = roundDown((0.16 * width) / pixelsPerMm);
    this.scaleBar(mm, mm * pixelsPerMm);
  }

  /** Sorts translucent surfaces: the farthest is drawn first, and a region inside another before the outer region. */
  private sortSurfaces(): void {
    this.camera.getWorldDirection(this.viewing);
    for (const entry of this.sorted) entry.distance = this.distance(entry.surface);
    this.sorted.sort((a, b) => b.distance - a.distance);
    this.sorted.forEach(({ surface }, order) => (surface.object.renderOrder = order));
  }

  private distance(surface: RegionSurface): number {
    if (surface.region.background) return -Infinity;
    const around = this.surfaces.find((other) => !other.region.background && other.holds(surface));
    return around ? this.distance(around) + 1e-3 : surface.centre.dot(this.viewing);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width === 0 || height === 0) return;
    const size = this.renderer.getSize(new THREE.Vector2());
    if (size.x !== width || size.y !== height) this.renderer.setSize(width, height);
    fitPicture(this.camera, width / height, this.halfSize);
    this.render();
  }

  /** Computes centre and size of the view from the organs, the entries and the template. */
  private frameOrgans({ scene }: Anatomy): void {
    const bounds = organBounds(scene);
    if (scene.template) bounds[2][0] = Math.min(bounds[2][0], scene.template.z_mm - 8);
    const [x, y, z] = bounds;
    this.centre.set((x[0] + x[1]) / 2, (y[0] + y[1]) / 2, (z[0] + z[1]) / 2);
    this.halfSize = 0.56 * Math.max(z[1] - z[0], 0.8 * Math.hypot(x[1] - x[0], y[1] - y[0]));
  }
}
