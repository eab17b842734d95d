// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the guide template over a section: in the transverse section its holes with the names of columns and rows, in
// the sagittal section its plate from the side.
import { circle, strokeLine } from '../../../shared/canvas';
import { INK, SOFT } from '../../../shared/plot_style';
import type { CanvasBox } from '../canvas_box';
import type { Hole, Scene } from '../scene';

export interface Place {
  u(x: number, z: number): number;  // [CSS px]
  v(y: number): number;
  pixels: number;                   // per mm
}

export function drawTemplate(box: CanvasBox, scene: Scene, holes: Hole[], current: string, place: Place): void {
  const { context, text } = box;
  const { template } = scene;
  if (!template) return;
  const dot = Math.max(1, 0.22 * place.pixels);
  context.save();
  context.fillStyle = SOFT;
  for (const hole of holes) {
    // Upper-case letters and whole numbers are bolder, as on the plate.
    const whole = /^[A-Z]/.test(hole.name) && !hole.name.includes('.');
    context.globalAlpha = whole ? 0.9 : 0.45;
    circle(context, place.u(hole.x, 0), place.v(hole.y), whole ? 1.25 * dot : dot);
    context.fill();
  }
  context.globalAlpha = 1;
  const planned = new Set(scene.insertions.map((i) => i.hole));
  const ring = 0.3 * template.pitch_mm * place.pixels;
  for (const hole of holes) {
    const isCurrent = hole.name === current;
    if (!isCurrent && !planned.has(hole.name)) continue;
    context.strokeStyle = isCurrent ? INK : SOFT;
    context.lineWidth = isCurrent ? 1.8 : 1.2;
    circle(context, place.u(hole.x, 0), place.v(hole.y), ring);
    context.stroke();
  }
  context.fillStyle = SOFT;
  const fit = Math.min(0.78, (0.8 * template.pitch_mm * place.pixels * 1.7) / text);
  context.font = box.font(Math.max(0.55, fit));
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  const gap = 0.62 * template.pitch_mm * place.pixels + 0.25 * text;
  const { columns, rows } = template;
  for (let i = 0; i < columns.length; i++) context.fillText(columns[i], place.u(holes[i].x, 0), place.v(holes[0].y) + gap);
  for (let j = 0; j < rows.length; j++) {
    if (rows[j].includes('.')) continue;
    const first = holes[j * columns.length];
    context.fillText(rows[j], place.u(first.x, 0) - gap, place.v(first.y));
  }
  context.restore();
}

export function drawTemplateEdge(box: CanvasBox, scene: Scene, place: Place): void {
  const { context, text } = box;
  const { template } = scene;
  if (!template) return;
  const half = ((template.rows.length - 1) / 2 + 1) * template.pitch_mm;
  const u = place.u(0, template.z_mm);
  if (u < 0 || u > box.width - text) return;
  context.save();
  context.strokeStyle = SOFT;
  context.lineWidth = Math.max(2, 0.8 * place.pixels);
  context.globalAlpha = 0.6;
  strokeLine(context, u, place.v(template.centre_mm[1] - half), u, place.v(template.centre_mm[1] + half));
  context.restore();
}
