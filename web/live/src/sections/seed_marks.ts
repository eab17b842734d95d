// SPDX-License-Identifier: GPL-3.0-or-later
// Draws seeds near the plane of a section: planned seeds hollow, dropped seeds filled where they are now, and isodose
// lines of the dropped seeds.
import { INK, SOFT } from '../../../shared/plot_style';
import type { CanvasBox } from '../canvas_box';
import { IsodoseLines, LEVELS } from '../implant/isodose';
import { meanMotion, nextSeed, placesNow } from '../implant/implant';
import { SEED } from '../palette';
import type { Session } from '../session';
import type { Place } from './template_overlay';

const NEAR_MM = 2.6;  // seeds further from the plane are left out

export class SeedMarks {
  private readonly lines = new IsodoseLines();

  constructor(private readonly box: CanvasBox, private readonly session: Session, private readonly axis: 0 | 2) {}

  private get isThere(): boolean {
    return this.session.plan !== null;
  }

  drawDose(value: number, place: Place): void {
    const { dose, implant, seeds } = this.session;
    if (!this.isThere || !dose || !implant || implant.seeds.length === 0) return;
    const { context } = this.box;
    const scale = Math.max(1, this.box.text / 13);
    context.save();
    context.lineJoin = 'round';
    for (const { level, rings } of this.lines.of(dose, this.axis, value, meanMotion(implant, seeds))) {
      context.beginPath();
      for (const ring of rings) {
        ring.forEach(([a, b], i) => {
          // coordinates of the plane: x and y in the transverse section, y and z in the sagittal section
          const [u, v] = this.axis === 2 ? [place.u(a, 0), place.v(b)] : [place.u(0, b), place.v(a)];
          if (i === 0) context.moveTo(u, v);
          else context.lineTo(u, v);
        });
        context.closePath();
      }
      context.strokeStyle = 'rgba(255, 255, 255, 0.7)';
      context.lineWidth = (level.width + 1.6) * scale;
      context.stroke();
      context.strokeStyle = level.color;
      context.lineWidth = level.width * scale;
      context.stroke();
    }
    context.restore();
    this.drawKey();
  }

  drawSeeds(value: number, place: Place): void {
    const { plan, implant, seeds } = this.session;
    if (!this.isThere || !plan) return;
    const { context } = this.box;
    const half = plan.seed_length_mm / 2;
    const least = this.axis === 2 ? 0.23 * this.box.text : 0.16 * this.box.text;
    const radius = Math.max(least, (plan.seed_diameter_mm / 2) * place.pixels);
    const next = nextSeed(plan, implant);
    const dropped = new Set(implant?.seeds.map((seed) => seed.number));
    const path = (at: ArrayLike<number>, axis: ArrayLike<number>, grown: number) => {
      context.beginPath();
      if (this.axis === 2) context.arc(place.u(at[0], at[2]), place.v(at[1]), radius + grown, 0, 2 * Math.PI);
      else {
        const [z0, z1] = [at[2] - half * axis[2], at[2] + half * axis[2]];
        const [y0, y1] = [at[1] - half * axis[1], at[1] + half * axis[1]];
        const [u0, v0, u1, v1] = [place.u(0, z0), place.v(y0), place.u(0, z1), place.v(y1)];
        const angle = Math.atan2(v1 - v0, u1 - u0);
        context.arc(u0, v0, radius + grown, angle + Math.PI / 2, angle - Math.PI / 2);
        context.arc(u1, v1, radius + grown, angle - Math.PI / 2, angle + Math.PI / 2);
        context.closePath();
      }
    };
    const isNear = (at: ArrayLike<number>) => Math.abs(at[this.axis] - value) < (this.axis === 2 ? half + 0.4 : NEAR_MM);
    context.save();
    for (const needle of plan.needles) {
      for (const seed of needle.seeds) {
        if (!isNear(seed.planned_mm)) continue;
        const isNext = seed === next;
        context.globalAlpha = dropped.has(seed.number) ? 0.45 : isNext ? 1 : 0.8;
        context.strokeStyle = isNext ? SEED : SOFT;
        context.lineWidth = isNext ? 2.4 : 1.1;
        path(seed.planned_mm, seed.axis, isNext ? 1.5 : 0);
        context.fillStyle = 'rgba(255, 255, 255, 0.55)';
        context.fill();
        context.stroke();
      }
    }
    context.globalAlpha = 1;
    placesNow(implant, seeds).forEach((at, i) => {
      if (!at || !isNear(at)) return;
      path(at, implant!.seeds[i].axis, 0.6);
      context.fillStyle = SEED;
      context.fill();
      context.strokeStyle = '#fff';
      context.lineWidth = 1.2;
      context.stroke();
    });
    context.restore();
  }

  private drawKey(): void {
    const { context, height, text } = this.box;
    context.save();
    context.font = this.box.font(0.82, 600);
    context.textBaseline = 'alphabetic';
    context.textAlign = 'left';
    const y = height - 0.6 * text;
    let x = 0.7 * text;
    const write = (words: string, color: string) => {
      context.strokeStyle = 'rgba(255, 255, 255, 0.85)';
      context.lineWidth = 3;
      context.strokeText(words, x, y);
      context.fillStyle = color;
      context.fillText(words, x, y);
      x += context.measureText(words).width + 0.5 * text;
    };
    write('Dose', INK);
    for (const { percent, color } of LEVELS) write(`${percent} %`, color);
    context.restore();
  }
}
