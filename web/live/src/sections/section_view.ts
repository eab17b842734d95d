// SPDX-License-Identifier: GPL-3.0-or-later
// One section, oriented as in planning systems: anterior is up. In the transverse section the patient's right is at the
// left of the picture; in the sagittal section superior is at the left, as a transrectal probe shows it. Letters at the
// edges give the directions.
import { circle } from '../../../shared/canvas';
import { INK, lineScale, SOFT } from '../../../shared/plot_style';
import { roundDown } from '../../../shared/colors';
import type { Anatomy } from '../anatomy';
import { CanvasBox } from '../canvas_box';
import { RESTING } from '../palette';
import { focusBounds, holes, regionTriangles, samePatient, type Hole, type Scene } from '../scene';
import type { Session } from '../session';
import type { Frame } from '../wire';
import { makeEnds, tipErrorEnds } from '../tip_error';
import { drawCross, drawLine, drawRing } from '../tip_error_shapes';
import { ContourCutter } from './contour_cutter';
import { crossing, tipOf } from './needle_crossing';
import type { Plane } from './plane';
import { SeedMarks } from './seed_marks';
import { drawTemplate, drawTemplateEdge } from './template_overlay';

interface Section {
  region: number;
  now: ContourCutter;
  before: ContourCutter;  // of the undeformed surface
}

const TIP_ROOM_MM = 3;
const HIT = new Float32Array(3);
const TIP = new Float32Array(3);
const ENDS = makeEnds();

export class SectionView {
  readonly box: CanvasBox;
  private anatomy: Anatomy | null = null;
  private sections: Section[] = [];
  private holes: Hole[] = [];
  private cutBefore = NaN;  // position of the plane for which `before` was cut
  private window = { u: 0, v: 0, width: 100, height: 100 };  // [mm] centre and size of the area to show
  private focus = this.window;  // the part of it that does not depend on the needle
  private pixels = 1;       // CSS px per mm
  readonly hidden = new Set<number>();
  private readonly seedMarks: SeedMarks;

  constructor(box: HTMLElement, private readonly session: Session, readonly plane: Plane, private readonly other: Plane) {
    this.box = new CanvasBox(box, () => this.draw());
    this.seedMarks = new SeedMarks(this.box, session, plane.axis);
    for (const topic of ['plan', 'implant', 'seeds', 'dose'] as const) session.on(topic, this.box.request);
    // A drag in one section moves the plane of the other section.
    box.addEventListener('pointerdown', (e) => {
      if (e.button !== 0 || !this.anatomy) return;
      box.setPointerCapture(e.pointerId);
      other.set(this.otherAt(e.offsetX));
    });
    box.addEventListener('pointermove', (e) => {
      if (box.hasPointerCapture(e.pointerId)) other.set(this.otherAt(e.offsetX));
    });
    plane.onChange(this.box.request);
    other.onChange(this.box.request);
    session.on('frame', () => {
      if (this.anatomy?.tissueMoved || this.anatomy?.needleMoved) this.box.request();
    });
    let hole: string | undefined;
    session.on('status', (status) => {
      if (status.hole !== hole) this.box.request();
      hole = status.hole;
    });
  }

  setAnatomy(anatomy: Anatomy): void {
    const { scene } = anatomy;
    if (!this.anatomy || !samePatient(this.anatomy.scene, scene)) this.hidden.clear();
    this.anatomy = anatomy;
    this.cutBefore = NaN;
    this.sections = scene.regions.map((_, region) => {
      const triangles = regionTriangles(scene, region);
      return { region, now: new ContourCutter(triangles), before: new ContourCutter(triangles) };
    });
    this.sections.sort((a, b) => Number(scene.regions[b.region].background) - Number(scene.regions[a.region].background));
    this.holes = scene.template ? holes(scene.template) : [];
    this.setWindow(scene);
    this.box.request();
  }

  /** Horizontal position in the picture [CSS px] of a point of the patient. */
  private u(x: number, z: number): number {
    return this.box.width / 2 + this.pixels * ((this.plane.axis === 2 ? x : -z) - this.window.u);
  }

  private v(y: number): number {
    return this.box.height / 2 + this.pixels * (y - this.window.v);
  }

  /** Position of the other plane that belongs to a horizontal position in the picture [CSS px]. */
  private otherAt(pixels: number): number {
    const u = (pixels - this.box.width / 2) / this.pixels + this.window.u;
    return this.plane.axis === 2 ? u : -u;
  }

  private setWindow(scene: Scene): void {
    const [x, y, z] = focusBounds(scene, this.holes);
    const across: [number, number] = this.plane.axis === 2 ? x : [-z[1], -z[0]];
    this.focus = { u: (across[0] + across[1]) / 2, v: (y[0] + y[1]) / 2, width: across[1] - across[0], height: y[1] - y[0] };
  }

  /** Extends the shown area to the tip, if the needle is far outside or deep inside. */
  private showTip(): void {
    this.window = this.focus;
    const { frame } = this.session;
    if (!frame || this.plane.axis === 2) return;
    const [, y, z] = tipOf(frame, TIP);
    const { u, v, width, height } = this.focus;
    const [left, right] = [Math.min(u - width / 2, -z - TIP_ROOM_MM), Math.max(u + width / 2, -z + TIP_ROOM_MM)];
    const [top, bottom] = [Math.min(v - height / 2, y - TIP_ROOM_MM), Math.max(v + height / 2, y + TIP_ROOM_MM)];
    this.window = { u: (left + right) / 2, v: (top + bottom) / 2, width: right - left, height: bottom - top };
  }

  private draw(): void {
    const { anatomy, box, plane } = this;
    if (!anatomy) return;
    const edge = 2.4 * box.text;
    this.showTip();
    this.pixels = Math.max(0.1, Math.min((box.width - 2 * edge) / this.window.width, (box.height - 2 * edge) / this.window.height));
    const { scene } = anatomy;
    if (this.cutBefore !== plane.value) {
      for (const s of this.sections) s.before.cut(scene.points, plane.axis, plane.value);
      this.cutBefore = plane.value;
    }
    for (const s of this.sections) s.now.cut(anatomy.position, plane.axis, plane.value);
    this.drawTissue(scene);
    const place = { u: (x: number, z: number) => this.u(x, z), v: (y: number) => this.v(y), pixels: this.pixels };
    this.seedMarks.drawDose(plane.value, place);
    if (scene.template) {
      if (plane.axis === 2) drawTemplate(box, scene, this.holes, this.session.status?.hole ?? '', place);
      else drawTemplateEdge(box, scene, place);
    }
    this.drawOtherPlane();
    this.seedMarks.drawSeeds(plane.value, place);
    this.drawResting();
    this.drawNeedle();
    this.drawLetters();
    this.drawScale();
  }

  private trace(cutter: ContourCutter): void {
    const { context } = this.box;
    const transverse = this.plane.axis === 2;
    context.beginPath();
    for (let c = 0; c < cutter.contours; c++) {
      for (let i = cutter.starts[c]; i < cutter.starts[c + 1]; i++) {
        const [a, b] = [cutter.corners[2 * i], cutter.corners[2 * i + 1]];
        const u = transverse ? this.u(a, 0) : this.u(0, b);
        const v = this.v(transverse ? b : a);
        if (i === cutter.starts[c]) context.moveTo(u, v);
        else context.lineTo(u, v);
      }
      context.closePath();
    }
  }

  private drawTissue(scene: Scene): void {
    const { context } = this.box;
    const line = Math.max(1, this.box.text / 13);
    context.lineJoin = 'round';
    for (const s of this.sections) {
      if (this.hidden.has(s.region)) continue;
      const region = scene.regions[s.region];
      context.strokeStyle = context.fillStyle = region.color;
      this.trace(s.now);
      context.globalAlpha = region.background ? 0.1 : region.target ? 0.24 : 0.2;
      context.fill('evenodd');
    }
    for (const s of this.sections) {
      if (this.hidden.has(s.region)) continue;
      const region = scene.regions[s.region];
      context.strokeStyle = region.color;
      if (!region.background) {
        context.globalAlpha = 0.75;
        context.lineWidth = 1.1 * line;
        context.setLineDash([4 * line, 3 * line]);
        this.trace(s.before);
        context.stroke();
        context.setLineDash([]);
      }
      context.globalAlpha = region.background ? 0.6 : 1;
      context.lineWidth = (region.background ? 1.2 : 2.1) * line;
      this.trace(s.now);
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  private drawOtherPlane(): void {
    const { context, width, height } = this.box;
    context.save();
    context.strokeStyle = SOFT;
    context.globalAlpha = 0.55;
    context.setLineDash([2, 4]);
    context.beginPath();
    const u = this.plane.axis === 2 ? this.u(this.other.value, 0) : this.u(0, this.other.value);
    context.moveTo(u, 0.07 * height);
    context.lineTo(u, 0.93 * height);
    if (u > 0 && u < width) context.stroke();
    context.restore();
  }

  private drawNeedle(): void {
    const frame = this.session.frame;
    const scene = this.anatomy?.scene;
    if (!frame || !scene || frame.line.length < 6) return;
    const { context, text } = this.box;
    const { line } = frame;
    const tip = tipOf(frame, TIP);
    const r = Math.max(text * 0.34, (scene.needle.diameter_mm / 2) * this.pixels);
    context.save();
    this.drawShaft(line, INK, Math.abs(tip[0] - this.plane.value) < 3);
    if (this.plane.axis === 2) {
      this.drawCrossing(line, tip, INK, r);
    } else {
      this.drawTipError(frame, scene, r);
      circle(context, this.u(tip[0], tip[2]), this.v(tip[1]), r);
      context.fillStyle = '#f0e442';
      context.strokeStyle = INK;
      context.lineWidth = 1.5;
      context.fill();
      context.stroke();
    }
    context.restore();
  }

  /** Draws a needle's line. @param isNear whether the needle is near a sagittal plane; else it is faint */
  private drawShaft(line: Float32Array, color: string, isNear: boolean): void {
    const { context } = this.box;
    const diameter = this.anatomy?.scene.needle.diameter_mm ?? 0;
    const path = () => {
      context.beginPath();
      for (let i = 0; i < line.length; i += 3) context.lineTo(this.u(line[i], line[i + 2]), this.v(line[i + 1]));
    };
    context.lineCap = 'round';
    const width = this.plane.axis === 0 ? Math.max(2.5, diameter * this.pixels) : 1.2;
    if (this.plane.axis === 0) {
      context.strokeStyle = '#fff';
      context.lineWidth = width + 2.5;
      path();
      context.stroke();
    }
    context.strokeStyle = color;
    context.globalAlpha = this.plane.axis === 0 ? (isNear ? 1 : 0.45) : 0.5;
    context.lineWidth = width;
    path();
    context.stroke();
    context.globalAlpha = 1;
  }

  /** Draws where a needle crosses a transverse plane: filled, or empty at its tip if it does not reach the plane. */
  private drawCrossing(line: Float32Array, tip: Float32Array, color: string, r: number): void {
    const { context } = this.box;
    const crosses = crossing(line, this.plane.axis, this.plane.value, HIT);
    const at = crosses ? HIT : tip;
    circle(context, this.u(at[0], at[2]), this.v(at[1]), r);
    context.fillStyle = crosses ? color : '#fff';
    context.strokeStyle = crosses ? '#fff' : color;
    context.lineWidth = 2;
    context.fill();
    context.stroke();
  }

  /** Draws the needles that stay in the tissue. */
  private drawResting(): void {
    const frame = this.session.frame;
    const scene = this.anatomy?.scene;
    if (!frame || !scene) return;
    const { context, text } = this.box;
    const r = Math.max(text * 0.3, (scene.needle.diameter_mm / 2) * this.pixels);
    for (const line of frame.resting) {
      const tip = line.subarray(line.length - 3);
      context.save();
      this.drawShaft(line, RESTING, Math.abs(tip[0] - this.plane.value) < 3);
      if (this.plane.axis === 2) this.drawCrossing(line, tip, RESTING, r);
      context.restore();
    }
  }

  /** Draws the tip error. Its points are places in the undeformed patient, like the dashed outlines. */
  private drawTipError(frame: Frame, scene: Scene, radius: number): void {
    if (!tipErrorEnds(frame, scene.needle.length_mm, ENDS)) return;
    const { context } = this.box;
    const [planned, reached] = [ENDS.planned, ENDS.reached].map(([x, y, z]) => [this.u(x, z), this.v(y)] as const);
    drawLine(context, planned, reached, lineScale());
    drawRing(context, reached, 1.1 * radius);
    drawCross(context, planned, 2 * radius, radius);
  }

  private drawLetters(): void {
    const { context, width, height, text } = this.box;
    const transverse = this.plane.axis === 2;
    context.font = this.box.font(1.15, 650);
    context.fillStyle = INK;
    context.strokeStyle = 'rgba(255, 255, 255, 0.85)';
    context.lineWidth = 0.3 * text;
    context.textBaseline = 'middle';
    const at = 0.9 * text;
    const letter = (name: string, x: number, y: number) => {
      context.textAlign = 'center';
      context.strokeText(name, x, y);
      context.fillText(name, x, y);
    };
    const side = transverse ? height / 2 : height / 4;  // in the sagittal section the letters make room for the needle
    letter(transverse ? 'R' : 'S', at, side);
    letter(transverse ? 'L' : 'I', width - at, side);
    letter('A', width / 2, at);
    letter('P', width / 2, height - at);
  }

  private drawScale(): void {
    const { context, width, height, text } = this.box;
    const mm = roundDown(0.22 * width / this.pixels);
    const right = width - 1.1 * text;
    const y = height - 0.9 * text;
    context.strokeStyle = INK;
    context.lineWidth = Math.max(1.5, text / 8);
    context.beginPath();
    context.moveTo(right - mm * this.pixels, y - 0.25 * text);
    context.lineTo(right - mm * this.pixels, y);
    context.lineTo(right, y);
    context.lineTo(right, y - 0.25 * text);
    context.stroke();
    context.font = this.box.font(0.88);
    context.fillStyle = INK;
    context.textAlign = 'center';
    context.textBaseline = 'alphabetic';
    context.fillText(`${mm} mm`, right - (mm * this.pixels) / 2, y - 0.45 * text);
  }
}
