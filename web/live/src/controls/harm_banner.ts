// SPDX-License-Identifier: GPL-3.0-or-later
// Warns of harm by the needle: a large red text while it is at such a place, and a list with a line for each harm so
// far.
import { element } from '../../../shared/dom';
import { harmSentence, isHarm, regionLabel } from '../event_names';
import type { Session } from '../session';
import { TIP_STATES, type Event } from '../wire';

const MOST = 6;  // most lines of the list; the oldest are dropped

export class HarmBanner {
  private readonly now = element('p', 'harm-now');
  private readonly list = element('ul', 'harm-list');
  private written: string | null = null;  // text of the list

  constructor(root: HTMLElement, private readonly session: Session) {
    this.now.setAttribute('role', 'alert');
    this.list.setAttribute('aria-label', 'Harm caused by the needle');
    root.append(this.now, this.list);
    for (const topic of ['status', 'frame', 'scene', 'restart'] as const) session.on(topic, () => this.write());
    for (const topic of ['event', 'frame', 'restart', 'scene'] as const) session.on(topic, () => this.writeList());
    this.write();
    this.writeList();
  }

  private write(): void {
    const words = harmNow(this.session);
    if (this.now.textContent !== words) this.now.textContent = words;
    this.now.hidden = words === '';
  }

  private writeList(): void {
    const sentences = harmsSoFar(this.session).slice(-MOST).map(harmSentence);
    const key = sentences.join('\n');
    if (key === this.written) return;
    this.written = key;
    this.list.replaceChildren(...sentences.map((sentence) => element('li', '', sentence)));
    this.list.hidden = sentences.length === 0;
  }
}

/**
 * The harmful events up to the shown moment. All events of a recording are known from the start, so later ones are left
 * out.
 */
export function harmsSoFar({ events, frame }: Pick<Session, 'events' | 'frame'>): Event[] {
  if (!frame) return [];  // the shown moment is not known yet
  return events.filter((event) => isHarm(event) && (!frame.replayed || event.time_s <= frame.time));
}

/** The harm at this moment, in words; empty if there is none. */
export function harmNow({ status, scene, frame }: Pick<Session, 'status' | 'scene' | 'frame'>): string {
  const spared = new Set(scene?.regions.filter((r) => r.spared).map((r) => r.name));
  const inside = status?.inside ?? [];
  const harmed = inside.filter((name) => spared.has(name));
  if (harmed.length > 0) {
    const who = !harmed.includes(inside[0]) ? 'The needle’s shaft' : harmed.length === 1 ? 'The needle’s tip' : 'The needle';
    return `${who} is in the ${harmed.map(regionLabel).join(' and the ')}`;
  }
  const tip = frame ? TIP_STATES[frame.tipState] : '';
  return tip === 'on bone' ? 'The needle’s tip is on bone' : tip === 'through' ? 'The needle has come out of the body' : '';
}
