// SPDX-License-Identifier: GPL-3.0-or-later
// The X-ray picture, with a scale in centimetres.
import { strokeLine } from '../../../shared/canvas';
import { CanvasBox } from '../canvas_box';
import type { Session } from '../session';
import type { LiveXray } from './image';
import { PictureRateLabel } from './picture_rate';

const SCALE_COLOR = '#9fb4c7';
const OPAQUE = 0xff000000;

export class XrayView {
  readonly box: CanvasBox;
  private readonly buffer = document.createElement('canvas');
  private readonly rate = new PictureRateLabel();
  private drawn: LiveXray | null = null;

  constructor(root: HTMLElement, private readonly session: Session) {
    this.box = new CanvasBox(root, () => this.draw());
    root.append(this.rate.element);
    session.on('image', this.box.request);
  }

  get image(): LiveXray | null {
    return this.session.image?.modality === 'xray' ? this.session.image : null;
  }

  private draw(): void {
    const { box, image } = this;
    const { context, text } = box;
    context.fillStyle = '#000';
    context.fillRect(0, 0, box.width, box.height);
    context.fillStyle = SCALE_COLOR;
    context.font = box.font();
    context.textAlign = 'center';
    if (!image) return context.fillText('The first picture is being made.', box.width / 2, box.height / 2);
    this.fill(image);
    const side = Math.min(box.width, box.height);
    const scale = side / image.rows;
    const [left, top] = [(box.width - scale * image.columns) / 2, (box.height - scale * image.rows) / 2];
    context.drawImage(this.buffer, left, top, scale * image.columns, scale * image.rows);
    const cm = (10 / image.mm_per_pixel) * scale;
    context.strokeStyle = context.fillStyle = SCALE_COLOR;
    context.lineWidth = 2;
    strokeLine(context, left + text, box.height - 1.2 * text, left + text + 5 * cm, box.height - 1.2 * text);
    context.font = box.font(0.8);
    context.textAlign = 'left';
    context.textBaseline = 'bottom';
    context.fillText('5 cm at the gland', left + text, box.height - 1.4 * text);
    context.textAlign = 'right';
    context.fillText('Simulated. Not a medical device', left + scale * image.columns - 0.5 * text, box.height - 0.5 * text);
  }

  private fill(image: LiveXray): void {
    if (this.drawn === image) return;
    this.drawn = image;
    this.rate.drawn(image);
    this.buffer.width = image.columns;
    this.buffer.height = image.rows;
    const paint = this.buffer.getContext('2d');
    if (!paint) return;
    const data = paint.createImageData(image.columns, image.rows);
    const out = new Uint32Array(data.data.buffer);
    image.pixels.forEach((level, i) => (out[i] = OPAQUE | (level << 16) | (level << 8) | level));
    paint.putImageData(data, 0, 0);
  }
}
