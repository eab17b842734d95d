// SPDX-License-Identifier: GPL-3.0-or-later
// The plan to follow: dose so far, what to do for the next seed, and the needles of the plan.
import { button, element, keyButton } from '../../../shared/dom';
import type { HandControl } from '../hand';
import { onRepaintEvery } from '../../../shared/repaint';
import type { Session } from '../session';
import { depthToGo, droppedOf, isFinished, lostSeeds, nextNeedle, nextSeed, replayWords, whatToDo, type Plan } from './implant';

const WRITE_EVERY_MS = 60;

class PlanFigure {
  readonly box = element('div', 'figure');
  private readonly number = element('b');
  private readonly unit = element('span', 'unit');

  constructor(caption: string) {
    const value = element('div');
    value.append(this.number, this.unit);
    this.box.append(element('span', 'name', caption), value);
  }

  set(text: string, unit: string, title: string, reached = false): void {
    if (this.number.textContent !== text) this.number.textContent = text;
    if (this.unit.textContent !== unit) this.unit.textContent = unit;
    if (this.box.title !== title) this.box.title = title;
    this.box.classList.toggle('reached', reached);
  }
}

/** Drops, takes back, and changes needles: what keys and buttons do. */
export class ImplantActions {
  constructor(private readonly session: Session, private readonly hand: HandControl) {}

  /** Whether this case has a plan that this page can carry out, which that of a recording is not. */
  get isThere(): boolean {
    return this.session.plan !== null && !this.session.replaying;
  }
  drop(): void {
    this.session.command({ do: 'drop' });
  }
  undo(): void {
    this.session.command({ do: 'undo' });
  }
  /** Moves the needle to the depth of its next seed; with a train to its retraction plane, then back over the train. */
  go(): void {
    const depth = depthToGo(this.session.plan, this.session.implant);
    if (depth !== null) this.hand.setDepth(depth);
  }
  needle(index: number): void {
    this.hand.rest();
    this.session.command({ do: 'needle', index });
  }
  next(): void {
    const { plan, implant } = this.session;
    const needle = plan ? nextNeedle(plan, implant) : -1;
    if (needle >= 0 && needle !== plan?.current) this.needle(needle);
  }
}

export class ImplantPanel {
  private readonly d90 = new PlanFigure('D90 now');
  private readonly v100 = new PlanFigure('V100 now');
  private readonly count = new PlanFigure('Seeds');
  private readonly error = new PlanFigure('Mean seed error');
  private readonly todo = element('p', 'todo');
  private readonly list = element('div', 'needles');
  private readonly drop: HTMLButtonElement;
  private readonly undo: HTMLButtonElement;
  private readonly go: HTMLButtonElement;
  private readonly next: HTMLButtonElement;
  private readonly result: HTMLButtonElement;
  private chips: { chip: HTMLButtonElement; fill: HTMLElement }[] = [];
  private listed: Plan['needles'] | null = null;

  constructor(private readonly root: HTMLElement, private readonly session: Session, private readonly actions: ImplantActions, showResult: () => void) {
    const figures = element('div', 'plan-figures');
    figures.append(this.d90.box, this.v100.box, this.count.box, this.error.box);
    this.drop = keyButton('Drop', 'D', 'Drop the next seed where the tip is now', () => actions.drop());
    this.drop.classList.add('drop');
    this.undo = keyButton('Take back', 'U', 'Take the last seed back (also Ctrl Z)', () => actions.undo());
    this.go = keyButton('Go there', 'G', 'Move the needle to the planned depth of the next seed', () => actions.go());
    this.next = keyButton('Next needle', 'N', 'Put the next needle of the plan that has seeds in front of the patient', () => actions.next());
    this.result = button('Result', showResult);
    this.result.title = 'Goals, errors and their reasons so far';
    const row = element('div', 'plan-buttons');
    row.append(this.drop, this.go, this.undo, this.next, this.result);
    this.list.setAttribute('role', 'group');
    this.list.setAttribute('aria-label', 'Needles of the plan');
    this.todo.setAttribute('role', 'status');
    root.append(figures, this.todo, row, this.list);
    const write = onRepaintEvery(WRITE_EVERY_MS, () => this.write());
    for (const topic of ['plan', 'implant', 'frame', 'status', 'link'] as const) session.on(topic, write);
    this.write();
  }

  private write(): void {
    const { session } = this;
    const { plan, implant, frame, status } = session;
    const there = plan !== null;
    document.body.classList.toggle('has-plan', there);
    this.root.hidden = !there;
    if (!plan || !there) return;
    if (this.listed === null || this.listed.length !== plan.needles.length || this.listed.some((n, k) => n.name !== plan.needles[k].name)) this.build(plan);
    this.figures();
    const { text, inPlace } = session.replaying ? { text: replayWords(plan, implant), inPlace: false } : whatToDo(plan, implant, frame?.depth ?? 0);
    for (const action of [this.drop, this.go, this.undo, this.next]) action.hidden = session.replaying;
    if (this.todo.textContent !== text) this.todo.textContent = text;
    if (this.todo.title !== text) this.todo.title = text;
    this.todo.classList.toggle('in-place', inPlace);
    const seed = nextSeed(plan, implant);
    const can = session.steering && status?.paused !== true;
    this.drop.disabled = !can || !seed || implant?.train_from_mm != null;
    this.drop.classList.toggle('in-place', inPlace);
    const isTrain = plan.technique === 'preloaded';
    this.drop.title = isTrain ? 'Hold the train where it is; its seeds are left as you draw the needle back' : 'Drop the next seed where the tip is now';
    this.undo.title = isTrain ? 'Take the seeds of the last needle back into it (also Ctrl Z)' : 'Take the last seed back (also Ctrl Z)';
    this.go.title = isTrain ? 'Move the needle to its retraction plane; after Drop, back over its train' : 'Move the needle to the planned depth of the next seed';
    this.go.disabled = !can || !seed || inPlace || session.guest !== '';
    this.undo.disabled = !session.steering || !implant || (implant.seeds.length === 0 && implant.train_from_mm == null);
    const next = nextNeedle(plan, implant);
    this.next.disabled = !session.steering || next < 0 || next === plan.current;
    this.next.classList.toggle('suggested', !seed && next >= 0);
    this.result.classList.toggle('suggested', isFinished(implant) && !session.replaying);
    this.result.disabled = !implant || implant.seeds.length === 0;
    this.chips.forEach(({ chip, fill }, k) => {
      const of = plan.needles[k];
      const dropped = droppedOf(implant, k);
      const state = dropped >= of.seeds.length ? 'done' : dropped > 0 ? 'begun' : '';
      const name = `plan-needle ${k === plan.current ? 'current' : ''} ${k === next && !session.replaying ? 'next' : ''} ${state} ${of.ready || k === plan.current || session.replaying ? 'ready' : ''}`.replace(/ +/g, ' ').trim();
      if (chip.className !== name) chip.className = name;
      chip.disabled = !session.steering;
      fill.style.width = `${(100 * dropped) / of.seeds.length}%`;
      const readiness = session.replaying ? (k === plan.current ? '; the recorded one' : '') : k === plan.current ? '; it is in your hand' : of.ready ? '; ready' : '; it takes some seconds to prepare';
      const title = `Needle ${of.name}: ${dropped} of ${of.seeds.length} seeds dropped${readiness}`;
      if (chip.title !== title) {
        chip.title = title;
        chip.setAttribute('aria-label', title);
      }
    });
  }

  private figures(): void {
    const { plan, implant } = this.session;
    const { now, planned, error } = implant ?? {};
    const wait = implant?.computing && !now ? '…' : '–';
    const some = (implant?.seeds.length ?? 0) > 0;
    const number = (value: number | null | undefined, digits: number) => (value == null || !some ? (some ? wait : '–') : value.toFixed(digits));
    const relative = (plan?.prescription_Gy ?? 0) > 0;
    const none = !some ? '. Not known: no seed has been dropped yet' : '';
    const then = planned ? `; the plan reaches ${relative ? `${planned.d90_percent?.toFixed(0)} %` : `${planned.d90_Gy?.toFixed(0)} Gy`}` : '';
    this.d90.set(number(relative ? now?.d90_percent : now?.d90_Gy, relative ? 1 : 0), relative ? '%' : 'Gy',
      `Dose that 90 % of the gland receives from the seeds dropped so far, in percent of ${plan?.prescription_Gy} Gy${then}${this.session.replaying ? '. It is as it was computed when this was recorded' : now || none ? none : '. It is being computed'}`,
      relative && (now?.d90_percent ?? 0) >= 100);
    this.v100.set(number(now?.v100_percent, 1), '%',
      `Share of the gland that receives the prescribed dose${planned?.v100_percent != null ? `; the plan reaches ${planned.v100_percent.toFixed(1)} %` : ''}${none}`, (now?.v100_percent ?? 0) >= 95);
    const lost = lostSeeds(implant);
    this.count.set(String(implant?.seeds.length ?? 0), `of ${implant?.planned_seeds ?? 0}${lost > 0 ? `, ${lost} lost` : ''}`,
      `Seeds dropped so far, and seeds of the plan${lost > 0 ? `; ${lost} of them ${lost === 1 ? 'has' : 'have'} left the patient` : ''}`);
    this.error.set(some && error ? error.mean_mm.toFixed(1) : '–', 'mm', `Mean distance of the places at which the dropped seeds rest from their planned places, in the patient at rest${none}`);
  }

  private build(plan: Plan): void {
    this.listed = plan.needles;
    this.chips = plan.needles.map((needle, k) => {
      const chip = button('', () => this.actions.needle(k));
      const fill = element('i');
      chip.append(element('span', '', needle.name), fill);
      return { chip, fill };
    });
    this.list.replaceChildren(...this.chips.map((c) => c.chip));
  }
}
