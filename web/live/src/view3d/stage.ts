// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view: anatomy, needle, template, seeds and probe.
import { ContactMarks } from '../../../shared/contact_marks';
import { NeedleMesh } from '../../../shared/needle_mesh';
import { onRepaint } from '../../../shared/repaint';
import { BaseStage } from '../../../shared/stage';
import { VIEWS } from '../../../shared/views';
import type { Anatomy } from '../anatomy';
import { RESTING } from '../palette';
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

const NOTHING = new Float32Array(0);

export class Stage extends BaseStage {
  surfaces: RegionSurface[] = [];
  contacts = new ContactMarks(1.27);
  readonly cut = new CutPlane();
  readonly template = new TemplatePlate();
  readonly ghost = new GlandGhost(this.cut.clipping);
  readonly tipError = new TipErrorMark();
  readonly seeds = new SeedBodies();
  readonly probe = new ProbeBody();
  onFirstPicture: () => void = () => {};
  private needle = new NeedleMesh(1.27);
  private resting: NeedleMesh[] = [];  // needles that stay in the tissue
  private diameter = 1.27;
  private readonly pace: Pace;
  private drawn = false;
  private compiled = false;  // shaders are compiled in the background, because waiting for them would block the page

  /** @param box, scaleBar as for BaseStage */
  constructor(box: HTMLElement, scaleBar: (mm: number, px: number) => void) {
    const pace = new Pace(Math.min(devicePixelRatio, 2));
    super(box, scaleBar, { stencil: true }, pace.ratio);
    this.pace = pace;
    this.renderer.localClippingEnabled = true;
    this.scene.add(this.needle.object, this.contacts.object, this.cut.object, this.template.object, this.ghost.object, this.tipError.object, this.seeds.object, this.probe.object);
    this.look(VIEWS[0].from);
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  /** Shows a patient. @param again whether the same patient was shown before; then its appearance and the view stay */
  setAnatomy(anatomy: Anatomy, again: boolean): void {
    const before = this.surfaces;
    for (const surface of this.surfaces) {
      this.scene.remove(surface.object);
      surface.dispose();
    }
    this.scene.remove(this.needle.object, this.contacts.object, ...this.resting.map((needle) => needle.object));
    const { scene } = anatomy;
    this.needle = new NeedleMesh(scene.needle.diameter_mm);
    this.resting = [];
    this.diameter = scene.needle.diameter_mm;
    const contactsShown = this.contacts.object.visible;  // the check box applies to every patient
    this.contacts = new ContactMarks(scene.needle.diameter_mm);
    this.contacts.object.visible = contactsShown;
    this.surfaces = scene.regions.map((_, i) => new RegionSurface(anatomy, i, this.cut.clipping));
    if (again) this.surfaces.forEach((surface, i) => surface.copyLook(before[i]));
    this.setTranslucent(this.surfaces, ({ region }) => region.background);
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
    this.showResting(frame.resting);
    this.contacts.show(frame.line, frame.contacts);
    this.tipError.show(frame);
    this.draw();
  }

  private showResting(lines: Float32Array[]): void {
    while (this.resting.length < lines.length) {
      const needle = new NeedleMesh(this.diameter, RESTING);
      this.resting.push(needle);
      this.scene.add(needle.object);
    }
    this.resting.forEach((needle, i) => needle.show(lines[i] ?? NOTHING));
  }

  override readonly draw = onRepaint(() => {
    if (this.pace.tick(performance.now())) this.renderer.setPixelRatio(this.pace.ratio);
    this.render();
  });

  override render(): void {
    if (!this.compiled) return;
    this.tipError.fit(this.pixelsPerMm, this.pace.ratio);
    super.render();
    if (this.drawn) return;
    this.drawn = true;
    performance.mark('3D view');  // for measuring how long the page takes to open
    this.onFirstPicture();
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
