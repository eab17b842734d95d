// SPDX-License-Identifier: GPL-3.0-or-later
// The state of the simulation, as this page has received it. Parts of the page listen to the topics that they need.
import type { Command } from './commands';
import { understood, type Connection, type ConnectionListener } from './connection';
import type { LiveImage } from './imaging/image';
import type { Dose, Implant, Plan, Seeds } from './implant/implant';
import type { Scene } from './scene';
import { encodeCommand, encodeHand, encodeSeen, Kind, numberOf, type Event, type Frame, type Hand, type LiveMap, type Message, type Notice, type Status } from './wire';

interface Topics {
  link: void;       // the connection was opened or closed
  status: Status;
  scene: Scene;
  frame: Frame;
  event: Event;
  notice: Notice;
  plan: Plan | null; // the plan of seeds to follow; null: there is none
  implant: Implant; // the part of it that has been carried out
  seeds: Seeds;     // where the dropped seeds are now
  dose: Dose;       // the dose around the target
  image: LiveImage; // the newest ultrasound or X-ray picture
  map: LiveMap;     // the map of the template's holes
  restart: void;    // the needle is at a start; earlier events do not count
  stopped: void;    // the server has stopped the hand of this page, which had been silent
}

const MOST_EVENTS = 500;
const HERE_EVERY_MS = 250;  // while this page holds the needle, it says so often that it is still there
// Messages of which the server sends no more until the page has taken up the earlier ones, and the regular status.
const ANSWERED = new Set<Kind>([Kind.frame, Kind.status, Kind.seeds, Kind.dose, Kind.image]);

export class Session implements ConnectionListener {
  connected = false;
  lostAt = 0;                     // [ms] time at which the connection was lost; 0 if it was not
  attempts = 0;                   // failed attempts to connect since the page was opened or the connection was lost
  status: Status | null = null;
  scene: Scene | null = null;
  frame: Frame | null = null;
  frameAt = 0;                    // [ms] performance.now() when the last frame came
  map: LiveMap | null = null;
  plan: Plan | null = null;        // null: this case has no plan
  implant: Implant | null = null;
  seeds: Seeds | null = null;
  dose: Dose | null = null;
  image: LiveImage | null = null;
  events: Event[] = [];           // since the start of the insertion
  private newest = 0;             // number of the last message
  private handStopped = false;
  private letGo = false;          // the user has handed the needle over, so the page does not take it on its own
  private readonly listeners: { [K in keyof Topics]: ((what: Topics[K]) => void)[] } = {
    link: [], status: [], scene: [], frame: [], event: [], notice: [], map: [], plan: [], implant: [], seeds: [], dose: [], image: [], restart: [], stopped: [],
  };

  constructor(private readonly connection: Connection) {}

  start(): void {
    this.connection.open(this);
    setInterval(() => {
      if (this.connected && this.status?.you_hold) this.connection.send(encodeSeen(this.newest), true);
    }, HERE_EVERY_MS);
  }

  on<K extends keyof Topics>(topic: K, listener: (what: Topics[K]) => void): void {
    this.listeners[topic].push(listener);
  }

  /** Whether this page can move the needle. */
  get steering(): boolean {
    return this.connected && this.status?.state === 'ready' && this.status.you_hold === true && this.status.mode !== 'replay';
  }

  /** Whether a recording is shown instead of the live needle. */
  get replaying(): boolean {
    return this.status?.mode === 'replay';
  }

  /** The name of the device that moves the needle instead of a page; empty: there is none. */
  get guest(): string {
    const { device, mode } = this.status ?? {};
    return device && device !== 'page' && mode !== 'replay' ? device : '';
  }

  command(command: Command): void {
    if (command.do === 'release') this.letGo = true;
    if (command.do === 'take') this.letGo = false;
    this.connection.send(encodeCommand(command));
  }

  sendHand(hand: Hand): void {
    // A moving target is soon outdated and may be dropped. A stop must not be dropped.
    if (this.steering) this.connection.send(encodeHand(hand), hand.speed > 0);
  }

  /** Shows a message of this page. */
  notify(text: string, cure = ''): void {
    this.tell('notice', { text, cure });
  }

  opened(): void {
    this.connected = true;
    this.attempts = 0;
    this.lostAt = 0;
    this.takePlan(null);
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
    this.newest = numberOf(data);
    try {
      if (message) this.take(message);
    } finally {
      // Only now, so that a page that is busy with drawing gets fewer pictures.
      if (!message || ANSWERED.has(message.kind)) this.connection.send(encodeSeen(this.newest));
    }
  }

  private take(message: Message): void {
    switch (message.kind) {
      case Kind.scene:
        this.scene = message.scene;
        this.frame = this.image = null;
        this.restart();
        return this.tell('scene', message.scene);
      case Kind.frame:
        this.frame = message.frame;
        this.frameAt = performance.now();
        return this.tell('frame', message.frame);
      case Kind.status: return this.takeStatus(message.status);
      case Kind.event:
        if (message.event.kind === 'started') this.restart();
        this.events.push(message.event);
        if (this.events.length > MOST_EVENTS) this.events.shift();
        return this.tell('event', message.event);
      case Kind.notice: return this.tell('notice', message.notice);
      case Kind.plan: return this.takePlan(message.plan);
      case Kind.implant:
        this.implant = message.implant;
        return this.tell('implant', message.implant);
      case Kind.seeds:
        this.seeds = message.seeds;
        return this.tell('seeds', message.seeds);
      case Kind.dose:
        this.dose = message.dose;
        return this.tell('dose', message.dose);
      case Kind.image:
        this.image = message.image;
        return this.tell('image', message.image);
      case Kind.map:
        this.map = message.map;
        return this.tell('map', message.map);
    }
  }

  private takePlan(plan: Plan | null): void {
    this.plan = plan && plan.needles.length > 0 ? plan : null;
    if (!this.plan) this.implant = this.seeds = this.dose = null;
    this.tell('plan', this.plan);
  }

  private takeStatus(status: Status): void {
    // In a replay, the hole of the replayed scene is shown, not the hole of the live needle.
    if (status.mode === 'replay') status.hole = this.scene?.insertions[0]?.hole ?? '';
    const { newest, cure } = status.companion ?? { newest: '', cure: '' };
    if (newest && newest !== this.status?.companion?.newest) this.notify(`${status.companion?.name}: ${newest}.`, cure && `${cure}.`);
    this.status = status;
    const stopped = status.you_hold === true && status.hand_stopped === true;
    if (stopped && !this.handStopped) {
      this.tell('stopped', undefined);
      this.connection.send(encodeCommand({ do: 'go_on' }));
    }
    this.handStopped = stopped;
    // If nobody holds the needle, this page takes it, so that a first visitor need not know that it must be held.
    const free = status.state === 'ready' && status.held === false && !status.you_hold;
    if (free && !this.letGo) this.connection.send(encodeCommand({ do: 'take' }));
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
