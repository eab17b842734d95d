// SPDX-License-Identifier: GPL-3.0-or-later
// The needle's depth as a long track with a handle to drag, with marks of events and of the planned depth, and two
// buttons that push and pull while they are held.
import { circle, strokeLine } from '../../../shared/canvas';
import { ACCENT, HARM, INK, SEED, SOFT } from '../palette';
import { element } from '../../../shared/dom';
import { CanvasBox } from '../canvas_box';
import { saysHarm, withWords } from '../event_names';
import { clamp, type HandControl } from '../hand';
import { currentNeedle, droppedOf, isBeforeTrain, seedDepths } from '../implant/implant';
import type { Session } from '../session';
import { wheelNotches } from '../wheel';

const MARKED = 'puncture';  // the first contact is at the skin, which has its mark on the scale

export class PushBar {
  private readonly track = element('div', 'track');
  private readonly box: CanvasBox;
  private grabbed: number | null = null;  // [mm] distance from the handle to the point that was grabbed
  private readonly buttons: HTMLButtonElement[] = [];
  private readonly labelled: [number, number][] = [];  // sections of the track with a label above

  constructor(root: HTMLElement, private readonly session: Session, private readonly hand: HandControl) {
    const pull = this.holdButton('◀ Pull', -1);
    const push = this.holdButton('Push ▶', 1);
    root.append(pull, this.track, push);
    this.track.tabIndex = 0;
    this.track.setAttribute('role', 'slider');
    this.track.setAttribute('aria-label', 'Depth of the needle; arrows up and down push and pull');
    this.box = new CanvasBox(this.track, () => this.draw());
    this.track.addEventListener('pointerdown', (e) => this.grab(e));
    this.track.addEventListener('pointermove', (e) => this.drag(e));
    for (const end of ['pointerup', 'pointercancel'] as const) this.track.addEventListener(end, () => this.letGo());
    this.track.addEventListener('keydown', (e) => {
      if (e.shiftKey || (e.key !== 'ArrowRight' && e.key !== 'ArrowLeft')) return;
      e.preventDefault();
      hand.push(e.key === 'ArrowRight' ? 1 : -1);
    });
    root.addEventListener('wheel', (e) => {
      e.preventDefault();
      hand.push(wheelNotches(e));
    }, { passive: false });
    for (const topic of ['frame', 'event', 'restart', 'scene', 'plan', 'implant'] as const) session.on(topic, this.box.request);
    for (const topic of ['status', 'link'] as const) session.on(topic, () => this.update());
    hand.onChange(this.box.request);
  }

  private update(): void {
    const { steering } = this.session;
    for (const b of this.buttons) b.disabled = !steering;
    this.track.setAttribute('aria-disabled', String(!steering));
    this.box.request();
  }

  private holdButton(text: string, direction: number): HTMLButtonElement {
    const b = element('button', 'hold', text);
    b.type = 'button';
    b.disabled = true;
    this.buttons.push(b);
    let held = false;
    const turn = () => {
      if (!held) return;
      this.hand.hold(direction);
      requestAnimationFrame(turn);
    };
    const begin = () => {
      if (held) return;
      held = true;
      turn();
    };
    const end = () => {
      if (!held) return;
      held = false;
      this.hand.stop();
    };
    b.addEventListener('pointerdown', (e) => {
      b.setPointerCapture(e.pointerId);
      begin();
    });
    b.addEventListener('keydown', (e) => {
      if (e.key !== 'Enter' && e.key !== ' ') return;
      e.preventDefault();
      begin();
    });
    for (const over of ['pointerup', 'pointercancel', 'keyup', 'blur'] as const) b.addEventListener(over, end);
    return b;
  }

  /** Depths at the ends of the track [mm]. */
  private get ends(): [number, number] {
    const scene = this.session.scene;
    if (!scene) return [-10, 100];
    const planned = Math.max(60, ...scene.insertions.map((i) => i.depth_mm));
    const depth = this.session.frame?.depth ?? 0;
    return [Math.max(-scene.limits.behind_mm, Math.min(-10, depth - 5)), Math.min(scene.limits.depth_mm, Math.max(1.25 * planned, depth + 10))];
  }

  private toPixels(depth: number): number {
    const [low, high] = this.ends;
    const edge = 1.6 * this.box.text;
    return edge + ((depth - low) / (high - low)) * (this.box.width - 2 * edge);
  }

  private toDepth(pixels: number): number {
    const [low, high] = this.ends;
    const edge = 1.6 * this.box.text;
    return clamp(low + ((pixels - edge) / (this.box.width - 2 * edge)) * (high - low), low, high);
  }

  private grab(e: PointerEvent): void {
    const { frame } = this.session;
    if (!frame || e.button !== 0) return;
    this.track.setPointerCapture(e.pointerId);
    const at = this.toDepth(e.offsetX);
    // The track can be grabbed beside the handle too. The distance is kept, so that the needle does not jump.
    this.grabbed = at - frame.depth;
    this.track.classList.add('held');
  }

  private drag(e: PointerEvent): void {
    if (this.grabbed !== null) this.hand.setDepth(this.toDepth(e.offsetX) - this.grabbed);
  }

  private letGo(): void {
    if (this.grabbed === null) return;
    this.grabbed = null;
    this.track.classList.remove('held');
    this.hand.stop();
  }

  private draw(): void {
    const { context, width, height, text } = this.box;
    const { frame, scene, status, steering } = this.session;
    const [low, high] = this.ends;
    const middle = 0.42 * height;
    context.font = this.box.font(0.8);
    context.textBaseline = 'alphabetic';
    context.textAlign = 'center';
    context.strokeStyle = '#c3c8cf';
    context.fillStyle = SOFT;
    context.lineWidth = 1;
    for (let mm = Math.ceil(low / 5) * 5; mm <= high; mm += 5) {
      const x = this.toPixels(mm);
      const ten = mm % 10 === 0;
      strokeLine(context, x, middle + 0.45 * text, x, middle + (ten ? 0.95 : 0.7) * text);
      if (ten) context.fillText(mm === 0 ? 'skin' : String(mm), x, height - 0.25 * text);
    }
    const bar = (from: number, to: number, color: string, thick: number) => {
      context.strokeStyle = color;
      context.lineWidth = thick;
      context.lineCap = 'round';
      strokeLine(context, this.toPixels(from), middle, this.toPixels(to), middle);
    };
    bar(low, high, '#e3e6ea', 0.5 * text);
    if (!frame || !scene) return;
    const planned = scene.insertions.find((i) => i.name === status?.insertion)?.depth_mm;
    this.labelled.length = 0;
    const seeds = seedDepths(this.session.plan, this.session.implant);
    if (seeds) this.drawSeeds(seeds, middle, text);
    else if (planned !== undefined) this.flag(planned, middle, 'planned depth', SOFT, text);
    const events = withWords(this.session.events).filter((event) => event.depth_mm <= high);
    for (const event of events) if (saysHarm(event)) this.flag(event.depth_mm, middle, event.label, HARM, text);  // first, for room
    for (const event of events) {
      if (event.kind === MARKED && !saysHarm(event)) this.flag(event.depth_mm, middle, event.label, INK, text);
    }
    bar(low, frame.depth, steering ? ACCENT : SOFT, 0.34 * text);
    const target = this.hand.target.depth;
    if (steering && Math.abs(target - frame.depth) > 0.5) bar(frame.depth, target, '#8fc1df', 0.34 * text);
    this.drawHandle(this.toPixels(frame.depth), middle, width);
    const now = frame.depth.toFixed(1);
    if (this.track.getAttribute('aria-valuenow') !== now) {
      this.track.setAttribute('aria-valuenow', now);
      this.track.setAttribute('aria-valuemin', low.toFixed(0));
      this.track.setAttribute('aria-valuemax', high.toFixed(0));
      this.track.setAttribute('aria-valuetext', `${now} mm`);
    }
  }

  /** Marks the depths at which the needle's seeds are to be dropped: filled once they have been. */
  private drawSeeds(depths: number[], middle: number, text: number): void {
    const { context } = this.box;
    const { plan, implant } = this.session;
    const dropped = droppedOf(implant, plan?.current ?? -1);
    if (isBeforeTrain(plan, implant)) this.flag(currentNeedle(plan)!.depth_mm, middle, 'full depth', SEED, text);
    else if (depths[dropped] !== undefined) this.flag(depths[dropped], middle, `seed ${dropped + 1} of ${depths.length}`, SEED, text);
    depths.forEach((depth, i) => {
      const x = this.toPixels(depth);
      circle(context, x, middle, 0.3 * text);
      context.fillStyle = i < dropped ? SEED : '#fff';
      context.fill();
      context.strokeStyle = i <= dropped ? SEED : SOFT;
      context.lineWidth = 1.6;
      context.stroke();
    });
  }

  private flag(depth: number, middle: number, label: string, color: string, text: number): void {
    const { context } = this.box;
    const x = this.toPixels(depth);
    context.strokeStyle = color;
    context.lineWidth = 1.5;
    strokeLine(context, x, middle - 0.75 * text, x, middle + 0.4 * text);
    context.fillStyle = color;
    context.font = this.box.font(0.76);
    const room = context.measureText(label).width / 2 + 2;
    const at = clamp(x, room, this.box.width - room);
    // no room for the label, only the mark is drawn
    if (this.labelled.some(([from, to]) => at - room < to && at + room > from)) return;
    this.labelled.push([at - room, at + room]);
    context.fillText(label, at, middle - 0.85 * text);
  }

  private drawHandle(x: number, middle: number, width: number): void {
    const { context, text } = this.box;
    const { steering } = this.session;
    const r = 0.82 * text;
    circle(context, x, middle, r);
    context.fillStyle = steering ? ACCENT : '#8a9099';
    context.fill();
    context.lineWidth = 2;
    context.strokeStyle = '#fff';
    context.stroke();
    context.lineWidth = 1.6;
    context.beginPath();
    for (const k of [-1, 0, 1]) {
      context.moveTo(x + 0.25 * text * k, middle - 0.32 * text);
      context.lineTo(x + 0.25 * text * k, middle + 0.32 * text);
    }
    context.stroke();
    const depth = this.session.frame?.depth ?? 0;
    if (steering && !this.session.guest && depth < 1 && this.grabbed === null) {
      context.font = this.box.font(0.95, 600);
      context.fillStyle = ACCENT;
      context.textAlign = 'left';
      context.textBaseline = 'middle';
      context.fillText('Drag me to push the needle  ▶', Math.min(x + 1.3 * text, width - 18 * text), middle - 0.02 * text);
      context.textAlign = 'center';
      context.textBaseline = 'alphabetic';
    }
  }
}
