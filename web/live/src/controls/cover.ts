// SPDX-License-Identifier: GPL-3.0-or-later
// A card over the page while there is nothing to steer: when it connects, loads or has failed, or when pictures are
// old.
import { element } from '../../../shared/dom';
import { serverAddress } from '../connection';
import type { Session } from '../session';

const REFUSALS = [401, 403, 503];  // the token, the origin, too many viewers or connections

export class Cover {
  private readonly card = element('div', 'card');
  private readonly title = element('h2');
  private readonly text = element('p');
  private readonly cure = element('p', 'cure');
  private readonly bar = element('progress');
  private readonly work = element('details');
  private readonly stage = element('p');
  private timer = 0;
  private refusal = '';  // the server's reason for refusing the connection

  constructor(private readonly root: HTMLElement, private readonly session: Session) {
    this.work.append(element('summary', '', 'What is being done'), this.stage);
    this.card.append(this.title, this.bar, this.text, this.cure, this.work);
    this.card.setAttribute('role', 'status');
    root.append(this.card);
    this.bar.max = 1;
    for (const topic of ['link', 'status', 'scene'] as const) session.on(topic, () => this.update());
    this.update();
  }

  private update(): void {
    const { session } = this;
    const { connected, status, scene } = session;
    const old = !connected && scene !== null;
    window.clearTimeout(this.timer);
    this.root.classList.toggle('over', scene !== null && !old);
    const steerable = connected && status?.state === 'ready' && scene !== null;
    for (const part of document.querySelectorAll<HTMLElement>('main, .push, .replay')) part.inert = !steerable && !old;
    this.root.classList.toggle('old', old);
    document.body.classList.toggle('is-old', old);
    if (old) {
      const seconds = Math.max(0, Math.round((Date.now() - session.lostAt) / 1000));
      this.show('Connection lost', `The pictures are from ${new Date(session.lostAt).toLocaleTimeString()}, ${seconds} s ago. Reconnecting…`,
                seconds > 8 ? 'If this lasts, check whether stylet serve is still running.' : '', false);
      this.timer = window.setTimeout(() => this.update(), 1000);
    } else if (!connected) {
      if (session.attempts > 1) void this.askWhy();
      const why = session.attempts > 2 ? this.refusal || 'The server does not answer.' : 'Waiting for the simulation…';
      this.show('Connecting', why, session.attempts > 2 && !this.refusal ? 'Check whether stylet serve is still running.' : '',
                session.attempts <= 2);
    } else if (status?.state === 'failed') {
      this.show('This case could not be loaded', status.message ?? '', status.cure ?? '', false);
    } else if (status?.state === 'loading' || !scene) {
      const fraction = status?.fraction;
      this.show('Preparing the patient', status?.stage ? 'The tissue is being modelled. The first time, this may take minutes.' : 'Waiting for the server…', '', true,
                typeof fraction === 'number' ? fraction : null, sentence(status?.stage ?? ''));
    } else {
      if (!this.root.hidden) performance.mark('needle ready');  // for measuring how long the page takes to open
      this.root.hidden = true;
    }
  }

  /** Asks for the reason of a refusal with an HTTP request, because a refused WebSocket gives none. */
  private async askWhy(): Promise<void> {
    try {
      const answer = await fetch(serverAddress('live'));
      this.refusal = REFUSALS.includes(answer.status) ? (await answer.text()).trim() : '';
    } catch {
      this.refusal = '';
    }
  }

  private show(title: string, text: string, cure: string, busy: boolean, fraction: number | null = null, stage = ''): void {
    this.root.hidden = false;
    this.work.hidden = stage === '';
    if (this.stage.textContent !== stage) this.stage.textContent = stage;
    this.title.textContent = title;
    this.text.textContent = text;
    this.cure.textContent = cure;
    this.cure.hidden = cure === '';
    this.bar.hidden = !busy;
    if (fraction === null) this.bar.removeAttribute('value');
    else this.bar.value = fraction;
    this.bar.setAttribute('aria-label', title);
  }
}

function sentence(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
