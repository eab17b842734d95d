// SPDX-License-Identifier: GPL-3.0-or-later
// What this page knows of the simulation at the moment. Parts of the page listen to what concerns them.
import { understood, type Transport, type TransportListener } from './connection';
import type { Scene } from './scene';
import { encodeCommand, encodeHand, Kind, type Command, type Event, type Frame, type Hand, type LiveMap, type Notice, type Status } from './wire';

interface Topics {
  link: void;       // connected or not
  status: Status;
  scene: Scene;
  frame: Frame;
  event: Event;
  notice: Notice;
  map: LiveMap;     // of the template's holes
  restart: void;    // the needle is at a start: what happened before is over
}

const MOST_EVENTS = 500;

export class Session implements TransportListener {
  connected = false;
  lostAt = 0;                     // [ms] of the clock, when the connection was lost; 0 if there never was one
  attempts = 0;                   // in vain since the page was opened or the connection was lost
  status: Status | null = null;
  scene: Scene | null = null;
  frame: Frame | null = null;
  map: LiveMap | null = null;
  events: Event[] = [];           // since the start of time
  private letGo = false;          // the user gave the needle away: do not take it by itself
  private readonly listeners: { [K in keyof Topics]: ((what: Topics[K]) => void)[] } = {
    link: [], status: [], scene: [], frame: [], event: [], notice: [], map: [], restart: [],
  };

  constructor(private readonly transport: Transport) {}

  start(): void {
    this.transport.open(this);
  }

  on<K extends keyof Topics>(topic: K, listener: (what: Topics[K]) => void): void {
    this.listeners[topic].push(listener);
  }

  /** Whether this page moves the needle now. */
  get steering(): boolean {
    return this.connected && this.status?.state === 'ready' && this.status.you_hold === true && this.status.mode !== 'replay';
  }

  /** What moves the needle in the pages' place now; empty: nothing does. */
  get guest(): string {
    const { device, mode } = this.status ?? {};
    return device && device !== 'page' && mode !== 'replay' ? device : '';
  }

  command(command: Command): void {
    if (command.do === 'release') this.letGo = true;
    if (command.do === 'take') this.letGo = false;
    this.transport.send(encodeCommand(command));
  }

  sendHand(hand: Hand): void {
    // Where a hand is going is soon out of date; that it has let go is not.
    if (this.steering) this.transport.send(encodeHand(hand), hand.speed > 0);
  }

  /** Shows a message of this page's own. */
  notify(text: string, cure = ''): void {
    this.tell('notice', { text, cure });
  }

  opened(): void {
    this.connected = true;
    this.attempts = 0;
    this.lostAt = 0;
    this.restart();
    this.tell('link', undefined);
  }

  closed(): void {
    if (this.connected) this.lostAt = Date.now();
    this.connected = false;
    this.attempts++;
    this.tell('link', undefined);
  }

  message(data: ArrayBuffer): void {
    const message = understood(data);
    if (!message) return;
    switch (message.kind) {
      case Kind.scene:
        this.scene = message.scene;
        this.frame = null;
        this.restart();
        return this.tell('scene', message.scene);
      case Kind.frame:
        this.frame = message.frame;
        return this.tell('frame', message.frame);
      case Kind.status: return this.takeStatus(message.status);
      case Kind.event:
        if (message.event.kind === 'started') this.restart();
        this.events.push(message.event);
        if (this.events.length > MOST_EVENTS) this.events.shift();
        return this.tell('event', message.event);
      case Kind.notice: return this.tell('notice', message.notice);
      case Kind.map:
        this.map = message.map;
        return this.tell('map', message.map);
    }
  }

  private takeStatus(status: Status): void {
    // A replay is of the hole of its scene, whatever the live needle was in.
    if (status.mode === 'replay') status.hole = this.scene?.insertions[0]?.hole ?? '';
    this.status = status;
    // A page that finds the needle free takes it, so that a first visitor need not know about holding it.
    const free = status.state === 'ready' && status.held === false && !status.you_hold;
    if (free && !this.letGo) this.transport.send(encodeCommand({ do: 'take' }));
    this.tell('status', status);
  }

  private restart(): void {
    this.events = [];
    this.tell('restart', undefined);
  }

  private tell<K extends keyof Topics>(topic: K, what: Topics[K]): void {
    for (const listener of this.listeners[topic]) listener(what);
  }
}
