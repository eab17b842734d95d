// SPDX-License-Identifier: GPL-3.0-or-later
// The dialogs with help and with the list of recordings.
import { button, element } from '../../../shared/dom';
import { serverAddress } from '../connection';
import type { Session } from '../session';
import { KEYS } from './keyboard';

interface Recording {
  name: string; case?: string; needle?: string | null; seconds?: number; ended?: boolean; peak_force_N?: number | null;
  seeds?: { dropped: number; planned: number; d90_percent: number | null } | null; problem?: string;
}

/** The result of a recording in words, and how it ended if that is not by itself. */
export function resultWords({ seeds, peak_force_N, ended, problem, name }: Recording, beingRecorded = ''): string {
  if (problem) return `It cannot be read: ${problem}`;
  const words: string[] = [];
  if (seeds) {
    words.push(`${seeds.dropped} of ${seeds.planned} seeds`);
    if (seeds.d90_percent !== null) words.push(`D90 ${seeds.d90_percent.toFixed(1)} %`);
  } else if (peak_force_N != null) {
    words.push(`at most ${peak_force_N.toFixed(1)} N`);
  }
  if (name === beingRecorded) words.push('being recorded');
  else if (ended === false) words.push('interrupted');
  return words.join(', ');
}

/** Makes a dialog with a title and a button that closes it. */
export function dialog(title: string): { dialog: HTMLDialogElement; body: HTMLElement } {
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
    'To push the needle, drag the blue handle at the bottom, turn the wheel over the 3D view, or hold ↑.',
    'Solid outlines show the organs displaced by the needle, dashed outlines show the organs at rest. A cross marks the planned position of the tip, a ring the tissue point that the tip has reached. Both are drawn in the patient at rest, and the distance between them is how far the tip is off its target. Over a section, the wheel moves its plane and a drag moves the plane of the other section.',
    'In the transverse section the patient’s right is at the left of the picture. In the sagittal section superior (the base of the gland) is at the left, as in the picture of a transrectal probe.',
    'In a case with a plan of seeds, go to the depth of the next seed and drop it with D; a preloaded needle goes to its full depth, D holds its train, and the seeds are left as you draw back. Pale seeds are planned, orange seeds have been dropped and move with the tissue. Lines in the sections show where the dropped seeds give 50, 100 and 150 % of the prescribed dose; they move with the seeds by their mean motion.',
    'With a gamepad, the left stick or the triggers push the needle, the right stick tilts it, and the shoulder buttons turn the bevel.',
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
    const of = element('td', '', recording.case ?? '');
    if (recording.needle) of.append(element('span', 'quiet', ` needle ${recording.needle}`));
    const cells = [element('td', '', recording.name), of,
                   element('td', '', resultWords(recording, session.status?.recording?.name)),
                   element('td', 'number', recording.seconds === undefined ? '' : `${recording.seconds.toFixed(1)} s`),
                   element('td'), element('td')];
    cells[4].append(play);
    cells[5].append(curve);
    tr.append(...cells);
    return tr;
  };
  const fill = async () => {
    body.replaceChildren(element('p', 'quiet', 'Fetching the list from the server…'));
    try {
      const answer = await fetch(serverAddress('recordings'));
      if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
      const recordings = (await answer.json()) as Recording[];
      if (recordings.length === 0) {
        body.replaceChildren(element('p', 'quiet', 'There are no recordings yet. Every insertion is recorded automatically.'));
        return;
      }
      const table = element('table');
      const head = element('tr');
      head.append(...['Recording', 'Case', 'Result', 'Length'].map((text) => element('th', '', text)));
      table.append(head, ...recordings.map(row));
      body.replaceChildren(table);
      if (session.status?.you_hold !== true) body.append(element('p', 'quiet', 'Only the viewer who holds the needle can start a replay.'));
    } catch (error) {
      body.replaceChildren(element('p', 'quiet', `The list could not be fetched: ${error instanceof Error ? error.message : String(error)}.`));
    }
  };
  return () => {
    void fill();
    if (!d.open) d.showModal();
  };
}
