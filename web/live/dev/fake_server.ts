// SPDX-License-Identifier: GPL-3.0-or-later
// A made-up server inside the page: enough behaviour to look at every part of it. Its forces are invented.
// ?fake opens it; ?fake&watch as a viewer without the needle, &failed, &loading, &lost for these states; &plan with a
// plan of seeds, of which &plan=2 leaves two to be dropped.
import type { Command } from '../src/commands';
import type { Transport, TransportListener } from '../src/connection';
import { holes } from '../src/scene';
import { Kind, type Frame, type Hand } from '../src/wire';
import { encodeFrame, encodeScene, encodeText } from './encode';
import { FakeImplant } from './fake_implant';
import { BODIES, makePatient, SKIN_Z } from './fake_patient';

const POINTS = 40;
const UNIT = 1e-3;
const REPLAY_S = 4;

export class FakeServer implements Transport {
  private readonly patient = makePatient();
  private listener: TransportListener | null = null;
  private readonly options = new URLSearchParams(location.search);
  private hole = 'e3.5';
  private entry: [number, number] = [15, 5];
  private hand: Hand = { depth: -5, speed: 20, roll: 0, tiltLeft: 0, tiltAnterior: 0 };
  private depth = -5;
  private force = 0;
  private time = 0;
  private steps = 0;
  private paused = false;
  private inside: string[] = [];
  private touched = false;
  private whole = true;
  private replay: { time: number; rate: number } | null = null;
  private readonly implant = this.options.has('plan') ? new FakeImplant(this.patient) : null;
  private toldShift = NaN;
  private holds = !this.options.has('watch');

  open(listener: TransportListener): void {
    this.listener = listener;
    setTimeout(() => this.begin(), 30);
  }

  private begin(): void {
    this.listener?.opened();
    if (this.options.has('failed')) {
      return this.say(Kind.status, { state: 'failed', message: 'scenarios/demo.toml: patient.source "nowhere.dcm": no such file', cure: 'Give the name of an RTSTRUCT, a label mask or a mesh, relative to the scenario.' });
    }
    this.say(Kind.status, { state: 'loading', stage: 'optimising elements', fraction: 0.4 });
    if (this.options.has('loading')) return;
    this.listener?.message(encodeScene(this.patient));
    if (this.implant && this.options.get('plan')) this.implant.dropMost(Number(this.options.get('plan')));
    if (this.implant) this.takeNeedle(this.implant.plan.current);
    else this.start();
    setInterval(() => this.turn(), 16);
    setInterval(() => this.tellStatus(), 400);
    if (this.options.has('lost')) setTimeout(() => this.listener?.closed(5000), 2500);
  }

  send(data: ArrayBuffer): void {
    const view = new DataView(data);
    if (view.getUint32(0, true) === Kind.hand) {
      const [depth, speed, roll, tiltLeft, tiltAnterior] = [0, 1, 2, 3, 4].map((i) => view.getFloat32(8 + 4 * i, true));
      this.hand = { depth, speed, roll, tiltLeft, tiltAnterior };
    } else this.obey(JSON.parse(new TextDecoder().decode(new Uint8Array(data, 8))) as Command);
    if (this.paused) this.turn();
  }

  private obey(command: Command): void {
    if (this.implant && this.obeyImplant(this.implant, command)) return;
    if (command.do === 'hole') {
      const template = this.patient.text.template;
      const hole = template && holes(template).find((h) => h.name === command.hole);
      if (!hole || Math.abs(hole.x) > 27 || hole.y < -27) {
        return this.say(Kind.notice, { text: `A needle through hole ${command.hole} misses the patient.`, cure: 'Choose a hole nearer to the middle.' });
      }
      this.hole = hole.name;
      this.entry = [hole.x, hole.y];
      this.start();
    } else if (command.do === 'reset') this.start();
    else if (command.do === 'pause') this.paused = true;
    else if (command.do === 'resume') this.paused = false;
    else if (command.do === 'replay') {
      this.start();
      this.replay = { time: 0, rate: 1 };
    } else if (command.do === 'live') {
      this.replay = null;
      this.start();
    } else if (command.do === 'seek' && this.replay) this.replay.time = command.time_s;
    else if (command.do === 'play' && this.replay) this.replay.rate = command.rate;
    else if (command.do === 'take') this.holds = true;
    else if (command.do === 'release') this.holds = false;
    this.tellStatus();
  }

  private obeyImplant(implant: FakeImplant, command: Command): boolean {
    if (command.do === 'needle') this.takeNeedle(command.index);
    else if (command.do === 'drop') {
      const tip = [this.entry[0] + 0.0006 * Math.max(0, this.depth) ** 2, this.entry[1], SKIN_Z + this.depth];
      const why = this.depth > 0 ? implant.drop(tip, 1.6 * this.force) : 'needle: its tip is not in the tissue, so no seed was dropped';
      if (why) this.say(Kind.notice, { text: why, cure: 'Choose the next needle of the plan, or push the needle in.' });
    } else if (command.do === 'undo') implant.seeds.pop();
    else if (command.do === 'clear') implant.seeds.length = 0;
    else return false;
    this.tellImplant(implant);
    return true;
  }

  private tellImplant(implant: FakeImplant): void {
    this.say(Kind.plan, implant.plan);
    this.say(Kind.implant, implant.state());
    this.listener?.message(implant.dose());
    this.toldShift = NaN;
  }

  private takeNeedle(index: number): void {
    if (!this.implant) return;
    this.implant.plan.current = index;
    const needle = this.implant.plan.needles[index];
    this.hole = needle.hole;
    this.entry = [needle.entry_mm[0], needle.entry_mm[1]];
    this.start();
    this.tellImplant(this.implant);
  }

  private start(): void {
    this.depth = this.hand.depth = -5;
    this.hand.roll = this.hand.tiltLeft = this.hand.tiltAnterior = 0;
    this.time = this.steps = this.force = 0;
    this.inside = [];
    this.touched = false;
    this.whole = true;
    this.say(Kind.event, { kind: 'started', time_s: 0, depth_mm: -5, force_N: 0, region: `hole ${this.hole}` });
    this.tellStatus();
  }

  private tellStatus(): void {
    this.say(Kind.status, {
      state: 'ready', mode: this.replay ? 'replay' : 'live', paused: this.paused, insertion: `hole ${this.hole}`, hole: this.hole, inside: this.inside, you_hold: this.holds, held: true,
      asking: this.options.has('asked') ? 1 : 0, you_ask: false, viewers: this.options.has('watch') || this.options.has('asked') ? 2 : 1,
      device: this.options.has('guest') ? 'OpenIGTLink' : 'page', device_problem: this.options.has('guest') ? 'no client is connected to port 18944' : '',
      recording: { name: '2026-11-20-101500', seconds: this.time, problem: '' },
      replay: this.replay && { name: '2026-11-20-101500', time_s: this.replay.time, duration_s: REPLAY_S, playing: this.replay.rate > 0, rate: this.replay.rate },
      loop: { steps: this.steps, missed: this.options.has('late') ? 3 : 0, p50_us: 43, p99_us: 86, max_us: 231, rights: 'ordinary scheduling' },
      dropped_messages: 0, skipped_frames: 0,
    });
  }

  private say(kind: Kind, what: unknown): void {
    this.listener?.message(encodeText(kind, what));
  }

  private turn(): void {
    const samples: number[] = [];
    if (this.replay) this.turnReplay(this.replay, samples);
    else if (!this.paused) {
      for (let i = 0; i < 16; i++) this.step(samples);
      for (let i = 0; i < samples.length; i += 8) samples[i] -= this.time;
    }
    this.listener?.message(encodeFrame(this.frame(Float32Array.from(samples))));
    const shift = 1.6 * this.force;
    if (this.implant && !(Math.abs(shift - this.toldShift) < 0.01)) {
      this.toldShift = shift;
      this.say(Kind.seeds, this.implant.now(shift));
    }
    this.whole = false;
  }

  /** The whole curve with the first frame, then only the moment. */
  private turnReplay(replay: { time: number; rate: number }, samples: number[]): void {
    if (this.whole) {
      this.hand.depth = 66;
      while (this.time < REPLAY_S) this.step(samples);
      for (let i = 0; i < samples.length; i += 8) samples[i] -= replay.time;
    }
    replay.time = Math.min(REPLAY_S, replay.time + 0.016 * replay.rate);
    if (replay.time === REPLAY_S) replay.rate = 0;
    this.time = replay.time;
    this.depth = Math.min(66, 20 * replay.time - 5);
    this.force = Math.max(0, 0.35 + 0.028 * this.depth);
  }

  private step(samples: number[]): void {
    const dt = 1e-3;
    const way = this.hand.depth - this.depth;
    const moved = Math.sign(way) * Math.min(Math.abs(way), this.hand.speed * dt);
    this.depth += moved;
    this.time += dt;
    this.steps++;
    const tip = SKIN_Z + this.depth;
    const resistance = this.depth <= 0 ? 0 : moved < 0 ? -0.02 * this.depth : 0.35 + 0.028 * this.depth;
    this.force += (resistance - this.force) * Math.min(1, Math.abs(moved) / 1.2);
    if (this.depth > 0 && !this.touched) {
      this.touched = true;
      this.event('skin_contact', 'body');
    }
    const at = [this.entry[0], this.entry[1], tip];
    const inside = BODIES.filter((b) => b.centre.reduce((sum, c, k) => sum + ((at[k] - c) / b.half[k]) ** 2, 0) < 1).map((b) => b.name);
    for (const name of inside) {
      if (this.inside.includes(name)) continue;
      this.event('puncture', name);
      this.event('region_entered', name);
      this.force -= 0.6;
    }
    this.inside = inside;
    const wobble = 0.03 * Math.sin(40 * this.time);
    samples.push(this.time, this.depth, this.force + (this.depth > 0 ? wobble : 0), 0.15 * this.force, -0.08 * this.force, 43, this.depth > 0 ? 2 : 0, 0);
  }

  private event(kind: string, region: string): void {
    this.say(Kind.event, { kind, time_s: this.time, depth_mm: this.depth, force_N: this.force, region });
  }

  private frame(samples: Float32Array): Frame {
    const { points } = this.patient;
    const tip = [this.entry[0] + 0.0006 * Math.max(0, this.depth) ** 2, this.entry[1], SKIN_Z + this.depth];
    const line = new Float32Array(3 * POINTS);
    for (let i = 0; i < POINTS; i++) {
      const s = 200 * (i / (POINTS - 1));
      const z = tip[2] - 200 + s;
      line.set([this.entry[0] + 0.0006 * Math.max(0, z - SKIN_Z) ** 2, this.entry[1], z], 3 * i);
    }
    const contacts: number[] = [];
    for (let z = SKIN_Z + 1; z < tip[2]; z += 3) contacts.push(this.entry[0] + 0.0006 * (z - SKIN_Z) ** 2, this.entry[1], z, z > tip[2] - 12 ? 0 : 1);
    if (this.depth > 0) contacts.push(...tip, 2);
    const displacement = new Int16Array(points.length);
    const pull = 3.2 * this.force;
    for (let i = 0; i < points.length; i += 3) {
      const square = (points[i] - tip[0]) ** 2 + (points[i + 1] - tip[1]) ** 2 + 0.5 * (points[i + 2] - tip[2]) ** 2;
      const near = Math.exp(-square / 700) * pull;
      displacement.set([0.15 * near, 0.1 * near, near].map((u) => u / UNIT), i);
    }
    return {
      time: this.time, paused: this.paused, replayed: this.replay !== null, trusted: !this.options.has('late'), shown: true, whole: this.whole, approximate: false, unfelt: false, flags: 0,
      tipState: this.depth > 0 ? 2 : 0, sticking: contacts.length / 4, iterations: 1, steps: this.steps, missed: this.options.has('late') ? 3 : 0,
      depth: this.depth, force: Float32Array.of(this.force, 0.15 * this.force, -0.08 * this.force), torque: new Float32Array(3),
      tip: Float32Array.from(tip), base: Float32Array.of(this.entry[0], this.entry[1], tip[2] - 200), orientation: Float32Array.of(1, 0, 0, 0),
      hand: Float32Array.of(this.hand.roll, this.hand.tiltLeft, this.hand.tiltAnterior), hidden: 0, unit: UNIT,
      tipError: this.depth > 0 && !this.replay ? Float32Array.of(tip[0] - this.entry[0] - 0.15 * pull, -0.1 * pull, -pull) : new Float32Array(3).fill(NaN),
      tipErrorDepth: this.depth > 0 && !this.replay ? this.depth : NaN, line,
      contacts: Float32Array.from(contacts), contactForces: new Float32Array((3 * contacts.length) / 4), samples, displacement,
    };
  }
}
