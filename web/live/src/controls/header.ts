// SPDX-License-Identifier: GPL-3.0-or-later
// The header: case, holder of the needle, state of the recording, and buttons for recordings, picture and help.
import { button, element } from '../../../shared/dom';
import type { HandControl } from '../hand';
import type { Session } from '../session';

export interface HeaderActions { recordings: () => void; picture: () => void; help: () => void }

export class Header {
  private readonly cases = element('select');
  private readonly holder = element('div', 'holder');
  private readonly holderText = element('span');
  private readonly take: HTMLButtonElement;
  private readonly release: HTMLButtonElement;
  private readonly recording = element('span', 'recording');
  private readonly companion = element('span', 'companion');
  private readonly notice = element('span', 'not-medical');

  constructor(root: HTMLElement, private readonly session: Session, hand: HandControl, actions: HeaderActions) {
    const name = element('h1', 'brand', 'Stylet');
    this.cases.setAttribute('aria-label', 'Case');
    this.cases.addEventListener('change', () => {
      hand.rest();
      session.command({ do: 'case', index: this.cases.selectedIndex });
      this.cases.blur();
    });
    this.take = button('Ask for the needle', () => session.command({ do: session.status?.you_ask ? 'release' : 'take' }));
    this.release = button('Hand over', () => session.command({ do: 'release' }));
    this.holder.append(this.holderText, this.take, this.release);
    const ways = element('nav', 'ways');
    const help = button('?', actions.help);
    help.setAttribute('aria-label', 'Keys and help');
    help.className = 'help';
    ways.append(button('Recordings', actions.recordings), button('Picture', actions.picture), help);
    const notice = element('strong', '', 'Not a medical device');
    this.notice.append(notice);
    this.notice.title = 'A simulation for research and teaching. Do not base decisions about a patient on it.';
    root.append(name, this.cases, this.holder, this.recording, this.companion, this.notice, ways);
    session.on('scene', (scene) => {
      this.cases.replaceChildren(...scene.cases.map((c) => new Option(c)));
      this.cases.selectedIndex = scene.case;
      this.notice.title = scene.notice || this.notice.title;
      document.title = `${scene.name} – Stylet`;
    });
    session.on('status', () => this.update());
    session.on('link', () => this.update());
    this.update();
  }

  private update(): void {
    const { status, connected, scene } = this.session;
    const holds = status?.you_hold === true;
    const others = Math.max(0, (status?.viewers ?? 1) - 1);
    const asking = status?.asking ?? 0;
    this.cases.disabled = !connected || !holds;
    this.cases.hidden = !scene;
    if (scene && status?.state === 'ready') this.cases.selectedIndex = scene.case;
    const problem = status?.device_problem ? ` (${status.device_problem})` : '';
    const follows = this.session.guest && `The needle follows ${this.session.guest}${problem}`;
    const viewers = others === 0 ? '' : others === 1 ? ', 1 other viewer' : `, ${others} other viewers`;
    let text = '';
    if (!connected || status?.state !== 'ready') text = '';
    else if (holds && asking > 0) text = asking === 1 ? 'Another viewer asks for the needle' : `${asking} viewers ask for the needle`;
    else if (holds) text = `${follows || 'You hold the needle'}${viewers}`;
    else if (status.held) text = status.you_ask ? `You have asked for the needle${viewers}` : `${follows || 'You are watching'}${viewers}`;
    else text = `${follows || 'Nobody holds the needle'}${viewers}`;
    this.write(this.holderText, text);
    this.holder.className = `holder ${holds ? 'mine' : 'watching'} ${holds && asking > 0 ? 'asked' : ''}`;
    this.holder.hidden = text === '';
    this.take.hidden = holds;
    this.write(this.take, status?.you_ask ? 'Cancel the request' : status?.held ? 'Ask for the needle' : 'Take the needle');
    this.release.hidden = !holds || others === 0;
    const recording = status?.recording;
    const unrecorded = recording?.problem;
    const soon = recording?.warning ? `, but ${recording.warning}` : '';
    this.recording.hidden = !connected || !recording || status?.state !== 'ready' || status.mode === 'replay';
    this.recording.classList.toggle('problem', !!unrecorded || !!soon);
    this.write(this.recording, unrecorded ? `Not recording: ${unrecorded}` : recording ? `Recording ${recording.seconds.toFixed(0)} s${soon}` : '');
    this.recording.title = recording?.name ?? '';
    const companion = status?.companion;
    this.companion.hidden = !connected || !companion?.not_used;
    this.write(this.companion, companion ? `${companion.name}: ${companion.not_used} not used` : '');
    this.companion.title = companion?.newest ? `${companion.newest}. ${companion.cure}.` : '';
  }

  private write(where: HTMLElement, text: string): void {
    if (where.textContent !== text) where.textContent = text;
  }
}
