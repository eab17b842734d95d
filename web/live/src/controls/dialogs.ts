// SPDX-License-Identifier: GPL-3.0-or-later
// The dialogs with help and with the list of recordings.
import { button, element } from '../../../shared/dom';
import { serverAddress } from '../connection';
import type { Session } from '../session';
import { KEYS } from './keyboard';

interface Recording { name: string; seconds?: number; case?: string }

function dialog(title: string): { dialog: HTMLDialogElement; body: HTMLElement } {
  const d = element('dialog');
  const head = element('div', 'dialog-head');
  const close = button('×', () => d.close());
  close.setAttribute('aria-label', 'Close');
  head.append(element('h2', '', title), close);
  const body = element('div', 'dialog-body');
  d.append(head, body);
  d.setAttribute('aria-label', title);
  d.addEventListener('click', (e) => e.target === d && d.close());
  document.body.append(d);
  return { dialog: d, body };
}

export function makeHelp(session: Session): () => void {
  const { dialog: d, body } = dialog('Pushing the needle');
  const list = element('dl', 'keys');
  for (const [key, what] of KEYS) list.append(element('dt', '', key), element('dd', '', what));
  const reading = element('div', 'reading');
  for (const text of [
    'Drag the blue handle at the bottom, turn the wheel over the 3D view, or hold ↑.',
    'Solid outlines are the organs as the needle moves them, dashed ones where they were. A cross marks where the tip was to be, a ring the tissue it is in, both in the patient at rest: from one to the other is the tip error. Over a section the wheel moves its plane, a drag the plane of the other section.',
    'Transverse: the patient’s right is at the left of the picture. Sagittal: superior (the base of the gland) is at the left, as a transrectal probe shows it.',
    'A gamepad works too: left stick or triggers push, right stick tilts, shoulders turn the bevel.',
  ]) reading.append(element('p', '', text));
  const notice = element('p', 'cure');
  body.append(reading, list, notice);
  return () => {
    notice.textContent = `${session.scene?.notice ?? 'Not a medical device.'} Stylet ${session.scene?.version ?? ''}`;
    if (d.open) d.close();
    else d.showModal();
  };
}

export function makeRecordings(session: Session): () => void {
  const { dialog: d, body } = dialog('Recordings');
  const row = (recording: Recording) => {
    const tr = element('tr');
    const play = button('Replay', () => {
      session.command({ do: 'replay', name: recording.name });
      d.close();
    });
    play.disabled = session.status?.you_hold !== true;
    const curve = element('a', '', 'Force curve (CSV)');
    curve.href = serverAddress(`recordings/${encodeURIComponent(recording.name)}/forces.csv`);
    curve.download = `${recording.name}-forces.csv`;
    const cells = [element('td', '', recording.name), element('td', '', recording.case ?? ''),
                   element('td', 'number', recording.seconds === undefined ? '' : `${recording.seconds.toFixed(1)} s`),
                   element('td'), element('td')];
    cells[3].append(play);
    cells[4].append(curve);
    tr.append(...cells);
    return tr;
  };
  const fill = async () => {
    body.replaceChildren(element('p', 'quiet', 'Asking the server…'));
    try {
      const answer = await fetch(serverAddress('recordings'));
      if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
      const recordings = (await answer.json()) as Recording[];
      if (recordings.length === 0) {
        body.replaceChildren(element('p', 'quiet', 'There are none yet. Every insertion is recorded as it happens.'));
        return;
      }
      const table = element('table');
      table.append(...recordings.map(row));
      body.replaceChildren(table);
      if (session.status?.you_hold !== true) body.append(element('p', 'quiet', 'Only who holds the needle can start a replay.'));
    } catch (error) {
      body.replaceChildren(element('p', 'quiet', `The list could not be fetched: ${error instanceof Error ? error.message : String(error)}.`));
    }
  };
  return () => {
    void fill();
    if (!d.open) d.showModal();
  };
}
