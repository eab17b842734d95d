// SPDX-License-Identifier: GPL-3.0-or-later
// The ultrasound picture as a scanner shows it: the probe at the bottom, a scale in centimetres, the dots of the
// template, a caliper. The true places of needle and seeds can be drawn over it; they are off at first.
import { circle, strokeLine } from '../../../shared/canvas';
import { CanvasBox } from '../canvas_box';
import { holes, type Hole } from '../scene';
import type { Session } from '../session';
import type { LiveUltrasound } from './image';
import { PictureRateLabel } from './picture_rate';
import { inPatient, inPlane, letters } from './plane_axes';
import { extent, onLine, ScanConverter, type Tone, type Window } from './scan_converter';

const MOST_PIXELS = 620;         // along a side of the converted picture
const SCALE_COLOR = '#9fb4c7';
const DOT_COLOR = 'rgba(255, 214, 102, 0.75)';
const TRUE_COLOR = '#4cc2ff';
const CALIPER_COLOR = '#7dff9a';
const NEAR_PLANE_MM = 3;         // parts of the needle that are farther from the plane are drawn faintly

type Point = [number, number];

export class UltrasoundView {
  readonly box: CanvasBox;
  readonly tone: Tone = { gain_dB: 0, range_dB: 60, tgc_dB: [0, 0, 0, 0] };
  showTemplate = false;
  showTruth = false;
  onPointer: (text: string) => void = () => {};
  private readonly converter = new ScanConverter();
  private readonly rate = new PictureRateLabel();
  private readonly buffer = document.createElement('canvas');
  private pixels: ImageData | null = null;
  private place = { left: 0, top: 0, scale: 1, u: 0, v: 0 };  // of the picture on the canvas [CSS px], CSS px per mm
  private frozen: LiveUltrasound | null = null;
  private caliper: [Point, Point] | null = null;
  private holes: Hole[] = [];

  constructor(root: HTMLElement, private readonly session: Session) {
    this.box = new CanvasBox(root, () => this.draw());
    root.append(this.rate.element);
    session.on('image', this.box.request);
    session.on('scene', (scene) => {
      this.holes = scene.template ? holes(scene.template) : [];
      this.caliper = null;
    });
    session.on('frame', () => {
      if (this.showTruth) this.box.request();
    });
    this.box.canvas.addEventListener('pointerdown', (e) => {
      if (e.button !== 0 || !this.image) return;
      this.box.canvas.setPointerCapture(e.pointerId);
      const at = this.inPicture(e.offsetX, e.offsetY);
      this.caliper = [at, at];
      this.box.request();
    });
    this.box.canvas.addEventListener('pointermove', (e) => {
      const at = this.inPicture(e.offsetX, e.offsetY);
      if (this.box.canvas.hasPointerCapture(e.pointerId) && this.caliper) {
        this.caliper = [this.caliper[0], at];
        this.box.request();
      }
      this.tellPointer(at);
    });
    this.box.canvas.addEventListener('pointerup', () => {
      if (this.caliper && this.length() < 0.5) this.caliper = null;  // a click removes the caliper
      this.box.request();
    });
    this.box.canvas.addEventListener('pointerleave', () => this.onPointer(''));
  }

  /** The picture that is shown: the newest, or the one at which the user has frozen it. */
  get image(): LiveUltrasound | null {
    const { image } = this.session;
    return this.frozen ?? (image?.modality === 'ultrasound' ? image : null);
  }

  get isFrozen(): boolean {
    return this.frozen !== null;
  }

  freeze(on: boolean): void {
    this.frozen = null;
    if (on) this.frozen = this.image;
    this.box.request();
  }

  /** Length of the caliper [mm]. */
  length(): number {
    if (!this.caliper) return 0;
    const [[a, b], [c, d]] = this.caliper;
    return Math.hypot(c - a, d - b);
  }

  /** The place on the canvas [CSS px] of a point of the plane [mm]. */
  onCanvas(u: number, v: number): Point {
    const { left, top, scale } = this.place;
    return [left + scale * (u - this.place.u), top - scale * (v - this.place.v)];
  }

  private inPicture(x: number, y: number): Point {
    const { left, top, scale } = this.place;
    return [this.place.u + (x - left) / scale, this.place.v + (top - y) / scale];
  }

  private tellPointer([u, v]: Point): void {
    const { image } = this;
    const on = image && onLine(image, u, v);
    if (!image || !on) return this.onPointer('');
    const [x, y, z] = inPatient(image, u, v).map((mm) => mm.toFixed(1).replace('-', '−'));
    this.onPointer(`${(on[1] * image.depth_mm).toFixed(1)} mm from the probe; x ${x}, y ${y}, z ${z} mm`);
  }

  private draw(): void {
    const { box, image } = this;
    const { context } = box;
    context.fillStyle = '#000';
    context.fillRect(0, 0, box.width, box.height);
    if (!image) return this.write('The first picture is being made.');
    const [low, high, bottom, top] = extent(image);
    const edge = 3.4 * box.text;
    const scale = Math.min((box.width - 2 * edge) / (high - low), (box.height - 2 * edge) / (top - bottom));
    this.place = {
      left: box.width / 2, top: (box.height + scale * (top - bottom)) / 2, scale, u: (low + high) / 2, v: bottom,
    };
    this.rate.drawn(image);
    this.drawPicture(image, low, high, bottom, top, scale);
    this.drawScale(image);
    this.drawLetters(image);
    if (this.showTemplate && image.array === 'transverse') this.drawTemplate(image);
    if (this.showTruth) this.drawTruth(image);
    this.drawCaliper();
    context.fillStyle = SCALE_COLOR;
    context.font = box.font(0.8);
    context.textAlign = 'right';
    context.textBaseline = 'bottom';
    context.fillText('Simulated. Not a medical device', box.width - 0.5 * box.text, box.height - 0.3 * box.text);
  }

  private write(text: string): void {
    const { context, width, height } = this.box;
    context.fillStyle = SCALE_COLOR;
    context.font = this.box.font();
    context.textAlign = 'center';
    context.fillText(text, width / 2, height / 2);
  }

  private drawPicture(image: LiveUltrasound, low: number, high: number, bottom: number, top: number, scale: number): void {
    const sharp = scale * devicePixelRatio;
    const mmPerPixel = Math.max(1 / sharp, Math.max(high - low, top - bottom) / MOST_PIXELS);
    const window: Window = {
      left: low, bottom, mmPerPixel, width: Math.ceil((high - low) / mmPerPixel), height: Math.ceil((top - bottom) / mmPerPixel),
    };
    const { buffer } = this;
    const paint = buffer.getContext('2d');
    if (!paint) return;
    if (buffer.width !== window.width || buffer.height !== window.height || !this.pixels) {
      buffer.width = window.width;
      buffer.height = window.height;
      this.pixels = paint.createImageData(window.width, window.height);
    }
    this.converter.draw(image, window, this.tone, new Uint32Array(this.pixels.data.buffer));
    paint.putImageData(this.pixels, 0, 0);
    const [x, y] = this.onCanvas(low, bottom + window.height * mmPerPixel);
    this.box.context.imageSmoothingEnabled = true;
    this.box.context.drawImage(buffer, x, y, window.width * mmPerPixel * scale, window.height * mmPerPixel * scale);
  }

  /** Marks each centimetre of depth on the middle line, every fifth longer and with its number, and the focus. */
  private drawScale(image: LiveUltrasound): void {
    const { context, text } = this.box;
    const [low, high] = extent(image);
    const [x] = this.onCanvas(high, 0);
    context.strokeStyle = context.fillStyle = SCALE_COLOR;
    context.lineWidth = 1;
    context.font = this.box.font(0.8);
    context.textAlign = 'left';
    context.textBaseline = 'middle';
    context.beginPath();
    for (let cm = 0; 10 * cm <= image.depth_mm + 0.01; cm++) {
      const [, y] = this.onCanvas(0, image.radius_mm + 10 * cm);
      const long = cm % 5 === 0;
      context.moveTo(x, y);
      context.lineTo(x + (long ? 0.9 : 0.5) * text, y);
      if (long) context.fillText(cm === 0 ? '0 cm' : String(cm), x + 1.05 * text, y);
    }
    const [, bottom] = this.onCanvas(0, extent(image)[2]);
    for (let cm = Math.ceil(low / 10); 10 * cm <= high; cm++) {
      const [u] = this.onCanvas(10 * cm, 0);
      context.moveTo(u, bottom + 0.3 * text);
      context.lineTo(u, bottom + (cm % 5 === 0 ? 1.0 : 0.7) * text);
    }
    context.stroke();
    const [, focus] = this.onCanvas(0, image.radius_mm + image.focus_mm);
    context.beginPath();
    context.moveTo(x - 0.1 * text, focus);
    context.lineTo(x - 0.8 * text, focus - 0.4 * text);
    context.lineTo(x - 0.8 * text, focus + 0.4 * text);
    context.fill();
  }

  private drawLetters(image: LiveUltrasound): void {
    const { context, width, height, text } = this.box;
    context.fillStyle = '#fff';
    context.font = this.box.font(1, 600);
    context.textBaseline = 'middle';
    const [left, right] = letters(image.right);
    const [, up] = letters(image.up);
    context.textAlign = 'left';
    context.fillText(left, 0.5 * text, height / 2);
    context.textAlign = 'right';
    context.fillText(right, width - 0.5 * text, height / 2);
    context.textAlign = 'center';
    context.fillText(up, width / 2, 0.9 * text);
  }

  private drawTemplate(image: LiveUltrasound): void {
    const { context, text } = this.box;
    const { scene, status } = this.session;
    if (!scene?.template) return;
    const size = Math.max(1, 0.03 * scene.template.pitch_mm * this.place.scale);
    const at = (hole: Hole) => {
      const [u, v] = inPlane(image, [hole.x, hole.y, image.origin_mm[2]]);
      return this.onCanvas(u, v);
    };
    context.fillStyle = DOT_COLOR;
    context.font = this.box.font(0.75);
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    const { columns, rows } = scene.template;
    this.holes.forEach((hole, k) => {
      const [x, y] = at(hole);
      const whole = /^[A-Z]/.test(hole.name) && !hole.name.includes('.');
      circle(context, x, y, whole ? 1.4 * size : size);
      context.fill();
      if (hole.name === status?.hole) {
        context.strokeStyle = DOT_COLOR;
        circle(context, x, y, 0.3 * scene.template!.pitch_mm * this.place.scale);
        context.stroke();
      }
      const [column, row] = [k % columns.length, Math.floor(k / columns.length)];
      if (row === 0) context.fillText(columns[column], x, y + 1.1 * text);
      if (column === 0 && !rows[row].includes('.')) context.fillText(rows[row], x - 1.1 * text, y);
    });
  }

  /** Draws where needle and seeds truly are; parts far from the plane are faint. */
  private drawTruth(image: LiveUltrasound): void {
    const { context } = this.box;
    const { frame, seeds } = this.session;
    context.strokeStyle = TRUE_COLOR;
    context.lineWidth = 1.5;
    const line = frame?.line ?? new Float32Array(0);
    for (let k = 3; k + 2 < line.length; k += 3) {
      const a = inPlane(image, line.subarray(k - 3, k));
      const b = inPlane(image, line.subarray(k, k + 3));
      if (a[2] * b[2] > 0 && Math.min(Math.abs(a[2]), Math.abs(b[2])) > 4 * NEAR_PLANE_MM) continue;
      context.globalAlpha = Math.min(Math.abs(a[2]), Math.abs(b[2])) <= NEAR_PLANE_MM || a[2] * b[2] <= 0 ? 1 : 0.3;
      strokeLine(context, ...this.onCanvas(a[0], a[1]), ...this.onCanvas(b[0], b[1]));
      if (a[2] * b[2] > 0) continue;
      const share = a[2] / (a[2] - b[2]);
      const [x, y] = this.onCanvas(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]));
      circle(context, x, y, 5);
      context.stroke();
    }
    for (const seed of seeds?.now_mm ?? []) {
      const [u, v, off] = inPlane(image, seed);
      if (Math.abs(off) > 2 * NEAR_PLANE_MM) continue;
      context.globalAlpha = Math.abs(off) <= NEAR_PLANE_MM ? 1 : 0.4;
      const [x, y] = this.onCanvas(u, v);
      context.strokeRect(x - 3.5, y - 3.5, 7, 7);
    }
    context.globalAlpha = 1;
  }

  private drawCaliper(): void {
    if (!this.caliper) return;
    const { context, text } = this.box;
    const [from, to] = this.caliper.map(([u, v]) => this.onCanvas(u, v));
    context.strokeStyle = context.fillStyle = CALIPER_COLOR;
    context.lineWidth = 1.2;
    context.setLineDash([4, 3]);
    strokeLine(context, ...from, ...to);
    context.setLineDash([]);
    for (const [x, y] of [from, to]) {
      context.beginPath();
      context.moveTo(x - 5, y);
      context.lineTo(x + 5, y);
      context.moveTo(x, y - 5);
      context.lineTo(x, y + 5);
      context.stroke();
    }
    context.font = this.box.font(0.95, 600);
    context.textAlign = 'left';
    context.textBaseline = 'bottom';
    context.fillText(`${this.length().toFixed(1)} mm`, to[0] + 0.6 * text, to[1] - 0.2 * text);
  }
}
