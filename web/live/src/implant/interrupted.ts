// SPDX-License-Identifier: GPL-3.0-or-later
// Asks whether an implant that was begun and not finished is to be gone on with.
import { button, element } from '../../../shared/dom';
import { dialog } from '../controls/dialogs';
import type { Session } from '../session';
import type { Interrupted } from '../wire';

const MONTHS = ['January', 'February', 'March', 'April', 'May', 'June', 'July', 'August', 'September', 'October', 'November', 'December'];

/** A moment in the reader's time zone: "29 November, 17:05"; of another year with the year. */
export function momentWords(seconds: number, now = new Date()): string {
  const then = new Date(1000 * seconds);
  const year = then.getFullYear() === now.getFullYear() ? '' : ` ${then.getFullYear()}`;
  const two = (n: number) => String(n).padStart(2, '0');
  return `${then.getDate()} ${MONTHS[then.getMonth()]}${year}, ${two(then.getHours())}:${two(then.getMinutes())}`;
}

/** The question, and what going on means. */
export function offerWords({ recorded_s, seeds, planned_seeds, needle }: Interrupted, now?: Date): { question: string; meaning: string } {
  return {
    question: `Go on with the implant of ${seeds} of ${planned_seeds} seeds from ${momentWords(recorded_s, now)}?`,
    meaning: `It was not finished. ${seeds === 1 ? 'Its seed rests' : 'Its seeds rest'} where ${seeds === 1 ? 'it was' : 'they were'}, with the same dose${needle ? `, and needle ${needle} stands in front of the skin` : ''}.`,
  };
}

/** Shows the question to the page that holds the needle, once for each implant. */
export function offerInterrupted(session: Session): void {
  const { dialog: d, body } = dialog('An implant was interrupted');
  d.classList.add('offer');
  let asked = '';  // recording of the implant that the page has asked about
  const answer = (go_on: 0 | 1) => {
    session.command({ do: 'interrupted', go_on });
    d.close();
  };
  const ask = (implant: Interrupted) => {
    const { question, meaning } = offerWords(implant);
    const foot = element('div', 'card-foot');
    const go = button('Go on', () => answer(1));
    go.classList.add('primary');
    foot.append(button('Begin anew', () => answer(0)), go);
    body.replaceChildren(element('p', 'lead', question), element('p', 'quiet', meaning), foot);
    d.showModal();
    go.focus();
  };
  session.on('status', ({ interrupted }) => {
    if (!interrupted) {
      asked = '';
      if (d.open) d.close();
    } else if (session.steering && asked !== interrupted.recording) {
      asked = interrupted.recording;
      if (!d.open) ask(interrupted);
    }
  });
}
