// SPDX-License-Identifier: GPL-3.0-or-later
// Notices: why something was not done, and what to do instead. They disappear after some seconds.
import { button, element } from '../../../shared/dom';
import { harmSentence, isHarm } from '../event_names';
import type { Session } from '../session';

const SHOWN_MS = 9000;
const MOST = 3;

/** Announces events to screen readers as they happen. Events before the first frame of a scene are old and left out. */
export function speakEvents(root: HTMLElement, session: Session): void {
  const spoken = element('p', 'spoken');
  spoken.setAttribute('aria-live', 'polite');
  root.append(spoken);
  session.on('event', (event) => {
    if (!session.frame || session.frame.replayed) return;
    if (isHarm(event)) spoken.textContent = harmSentence(event);
    else if (event.label !== '') spoken.textContent = `${event.label}, ${event.depth_mm.toFixed(0)} mm, ${event.force_N.toFixed(1)} N`;
  });
}

export function showNotices(root: HTMLElement, session: Session): void {
  session.on('notice', ({ text, cure }) => {
    const known = [...root.children].find((c) => c.firstElementChild?.textContent === text);
    known?.remove();
    const note = element('div', 'notice');
    const close = button('×', () => note.remove());
    close.setAttribute('aria-label', 'Close this notice');
    note.append(element('p', '', text));
    if (cure) note.append(element('p', 'cure', cure));
    note.append(close);
    root.append(note);
    while (root.children.length > MOST) root.firstElementChild?.remove();
    setTimeout(() => note.remove(), SHOWN_MS);
  });
}
