// SPDX-License-Identifier: GPL-3.0-or-later
// The result of an implant: dose and goals beside the plan, errors of the seeds, and their reasons. It opens by itself
// when the last seed has been dropped and its dose is known.
import { button, element } from '../../../shared/dom';
import { dialog } from '../controls/dialogs';
import type { Session } from '../session';
import { isFinished, lostSeeds, tallyRows, type Goal, type Implant, type Score } from './implant';

const AXES: [string, string, string][] = [['Left–right', 'left', 'right'], ['Anterior–posterior', 'posterior', 'anterior'], ['Superior–inferior', 'superior', 'inferior']];

function signedWords(value: number, positive: string, negative: string): string {
  return Math.abs(value) < 0.05 ? '0.0 mm' : `${Math.abs(value).toFixed(1)} mm ${value > 0 ? positive : negative}`;
}

function row(...cells: (string | HTMLElement)[]): HTMLTableRowElement {
  const tr = element('tr');
  cells.forEach((cell, i) => {
    const td = element('td', i > 0 ? 'number' : '');
    td.append(cell);
    tr.append(td);
  });
  return tr;
}

function head(...cells: string[]): HTMLTableRowElement {
  const tr = element('tr');
  cells.forEach((cell, i) => tr.append(element('th', i > 0 ? 'number' : '', cell)));
  return tr;
}

const STRUCTURES: Record<string, string> = { prostate: 'Prostate', urethra: 'Urethra', rectum: 'Rectum', bladder: 'Bladder' };

/** The words of a goal: "Prostate D90 ≥ 100 %". */
export function goalWords({ structure, metric, at_least, bound }: Goal): string {
  const [figure, unit] = metric.split('_');
  return `${STRUCTURES[structure] ?? structure} ${figure} ${at_least ? '≥' : '≤'} ${bound} ${unitWords(unit)}`;
}

function unitWords(unit: string): string {
  return unit === 'percent' ? '%' : unit;
}

function goalValue(goal: Goal | undefined): string {
  if (goal?.value == null) return '–';
  return `${goal.value.toFixed(goal.value < 10 ? 1 : 0)} ${unitWords(goal.metric.split('_')[1])}`;
}

export class EndCard {
  private readonly dialog: HTMLDialogElement;
  private readonly body: HTMLElement;
  private finished: boolean | null = null;  // null: not known since the page was opened

  constructor(private readonly session: Session) {
    ({ dialog: this.dialog, body: this.body } = dialog('The implant'));
    this.dialog.classList.add('end-card');
    session.on('plan', () => {
      if (!session.plan) this.finished = null;  // also while the connection is opened again
    });
    session.on('scene', () => {
      if (!session.plan) this.dialog.close();  // another case
    });
    session.on('implant', (implant) => {
      const finished = isFinished(implant);
      const known = !implant.computing && implant.now !== null;
      if (finished && known && this.finished === false && !session.replaying) this.show();
      else if (this.dialog.open && known) this.fill(implant);
      // A page that is opened after the end does not show the card by itself.
      if (!finished) this.finished = false;
      else if (known) this.finished = true;
    });
  }

  show(): void {
    const { implant } = this.session;
    if (!implant) return;
    this.fill(implant);
    if (!this.dialog.open) this.dialog.showModal();
  }

  private fill(implant: Implant): void {
    const { now, planned, seeds } = implant;
    const finished = isFinished(implant);
    const met = now?.goals.filter((g) => g.met).length ?? 0;
    const of = now?.goals.filter((g) => g.value !== null).length ?? 0;
    const could = planned?.goals.filter((g) => g.met).length ?? 0;
    const lead = element('p', 'lead');
    if (this.session.replaying) lead.append('At this moment of the recording: ');
    lead.append(element('b', '', finished ? 'The implant is finished. ' : `${seeds.length} of ${implant.planned_seeds} seeds have been dropped. `),
      of > 0 ? `It keeps ${met} of ${of} goals; the plan keeps ${could}.` : '');
    const columns = element('div', 'card-columns');
    const left = element('div');
    const right = element('div');
    columns.append(left, right);
    left.append(this.figures(now, planned), this.session.replaying ? element('p', 'cure', 'A recording has D90 and V100, not the other goals.') : this.goals(now, planned));
    right.append(...this.errors(implant), ...this.reasons(implant), ...this.tally(implant));
    const foot = element('div', 'card-foot');
    const again = button('Begin again with all seeds', () => {
      this.session.command({ do: 'clear' });
      this.session.command({ do: 'needle', index: 0 });
      this.dialog.close();
    });
    again.disabled = !this.session.steering;
    again.hidden = this.session.replaying;
    const close = button(finished ? 'Close' : 'Go on', () => this.dialog.close());
    close.classList.add('primary');
    foot.append(element('strong', 'not-medical', 'Not a medical device. A simulation for research and teaching.'), again, close);
    this.body.replaceChildren(lead, columns, foot);
    const lost = lostSeeds(implant);
    if (lost > 0) {
      lead.append(element('b', '', ` ${lost === 1 ? 'One seed is lost' : `${lost} seeds are lost`}:`),
        ` ${lost === 1 ? 'it has' : 'they have'} left the patient and ${lost === 1 ? 'gives' : 'give'} no dose.`);
    }
    if (seeds.some((seed) => !seed.in_tissue)) {
      lead.append(element('span', 'cure', ' Seeds that were dropped where the motion of the tissue is not known count as resting there.'));
    }
  }

  private figures(now: Score | null, planned: Score | null): HTMLElement {
    const box = element('div', 'card-figures');
    const one = (name: string, value: number | null | undefined, plan: number | null | undefined) => {
      const figure = element('div', 'figure');
      const number = element('div');
      number.append(element('b', '', value == null ? '–' : value.toFixed(1)), element('span', 'unit', '%'));
      figure.append(element('span', 'name', name), number, element('span', 'name', plan == null ? '' : `plan ${plan.toFixed(1)} %`));
      return figure;
    };
    box.append(one('D90', now?.d90_percent, planned?.d90_percent), one('V100', now?.v100_percent, planned?.v100_percent));
    return box;
  }

  private goals(now: Score | null, planned: Score | null): HTMLElement {
    const table = element('table', 'goals');
    table.append(head('Goal', 'Plan', 'Yours', ''));
    now?.goals.forEach((goal, k) => {
      if (goal.value === null) return;
      const mark = element('span', goal.met ? 'met' : 'missed', goal.met ? '✓ met' : '✗ missed');
      table.append(row(goalWords(goal), goalValue(planned?.goals[k]), goalValue(goal), mark));
    });
    return table;
  }

  private errors({ error }: Implant): HTMLElement[] {
    const table = element('table');
    table.append(row('Mean error', `${error.mean_mm.toFixed(1)} mm`), row('95 of 100 seeds within', `${error.p95_mm.toFixed(1)} mm`),
      row('Largest error', `${error.largest_mm.toFixed(1)} mm`));
    AXES.forEach(([name, positive, negative], k) => {
      const { mean, sd } = error.axes_mm[k];
      table.append(row(name, `${signedWords(mean, positive, negative)} ± ${sd.toFixed(1)}`));
    });
    return [element('h3', '', 'How far the seeds rest from their plan'), table];
  }

  private tally({ tally }: Implant): HTMLElement[] {
    if (!tally) return [];
    const table = element('table');
    for (const { what, often, harm } of tallyRows(tally)) table.append(row(what, element('span', harm ? 'missed' : '', often)));
    return [element('h3', '', 'All needles so far'), table];
  }

  /** The mean length of each cause's part of the error, as bars. */
  private reasons({ why }: Implant): HTMLElement[] {
    const largest = Math.max(1e-9, ...why.map((cause) => cause.mean_mm ?? 0));
    const list = element('div', 'reasons');
    for (const cause of [...why].sort((a, b) => (b.mean_mm ?? 0) - (a.mean_mm ?? 0))) {
      const line = element('div', 'reason');
      line.title = cause.meaning;
      const name = cause.cause === 'hand' ? 'your hand' : cause.cause;
      const bar = element('i');
      bar.style.width = `${(100 * (cause.mean_mm ?? 0)) / largest}%`;
      const track = element('span', 'reason-track');
      track.append(bar);
      const mean = cause.mean_xyz_mm[2];
      line.append(element('span', '', name[0].toUpperCase() + name.slice(1)), track, element('b', '', `${(cause.mean_mm ?? 0).toFixed(1)} mm`),
        element('span', 'name', `on average ${signedWords(mean, 'superior', 'inferior')}`));
      list.append(line);
    }
    return [element('h3', '', 'Why'), list];
  }
}
