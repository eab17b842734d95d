// SPDX-License-Identifier: GPL-3.0-or-later
// The clinician's view, in place of the 3D view: ultrasound or X-ray, with the controls of scanner, stepper and C-arm.
import { button, element, keyButton } from '../../../shared/dom';
import { onRepaint, onRepaintEvery } from '../../../shared/repaint';
import type { Session } from '../session';
import type { ProbeState, ShownImage } from './image';
import { UltrasoundView } from './ultrasound_view';
import { XrayView } from './xray_view';

const WRITE_EVERY_MS = 100;
const TABS: [ShownImage, string, string][] = [
  ['none', '3D', 'The patient in 3D'],
  ['transverse', 'Ultrasound', 'Ultrasound of the probe in the rectum'],
  ['xray', 'X-ray', 'Fluoroscopy'],
];

/** A slider with its name and value. */
class Slider {
  readonly row = element('label', 'knob');
  private readonly input = element('input');
  private readonly value = element('output');

  constructor(name: string, private readonly unit: string, low: number, high: number, step: number, changed: (value: number) => void, title = '') {
    this.input.type = 'range';
    this.input.min = String(low);
    this.input.max = String(high);
    this.input.step = String(step);
    this.row.title = title;
    this.row.append(element('span', '', name), this.input, this.value);
    this.input.addEventListener('input', () => {
      this.write(this.input.valueAsNumber);
      changed(this.input.valueAsNumber);
    });
  }

  /** Shows a value that somebody else has set, unless the user is moving the slider. */
  set(value: number): void {
    if (this.input.matches(':active')) return;
    this.input.value = String(value);
    this.write(value);
  }

  set disabled(on: boolean) {
    this.input.disabled = on;
  }

  private write(value: number): void {
    const text = `${value.toFixed(Number(this.input.step) < 1 ? 1 : 0).replace('-', '−')} ${this.unit}`;
    if (this.value.textContent !== text) this.value.textContent = text;
  }
}

function toggle(text: string, title: string, changed: (on: boolean) => void): HTMLButtonElement {
  const b = button(text, () => {
    const on = b.getAttribute('aria-pressed') !== 'true';
    b.setAttribute('aria-pressed', String(on));
    changed(on);
  });
  b.title = title;
  b.setAttribute('aria-pressed', 'false');
  return b;
}

export class ImagePanel {
  readonly ultrasound: UltrasoundView;
  private readonly tabs: HTMLButtonElement[];
  private readonly views = { ultrasound: element('div', 'canvas'), xray: element('div', 'canvas') };
  private readonly knobs = { ultrasound: element('div', 'knobs'), xray: element('div', 'knobs') };
  private readonly arrays: [ShownImage, HTMLButtonElement][];
  private readonly steps: HTMLButtonElement[];
  private readonly sliders: Record<string, Slider> = {};
  private readonly place = element('output', 'probe-place');
  private readonly tracked = element('p', 'quiet');
  private readonly pointer = element('output', 'pointer');
  private readonly note = element('p', 'view-note');
  private readonly freeze: HTMLButtonElement;
  private readonly wanted = new Map<string, number>();
  private readonly send = onRepaint(() => {
    for (const [key, value] of this.wanted) this.session.command({ do: 'set', key, value });
    this.wanted.clear();
  });

  /** @param root of the pictures; @param view3d hidden while a picture is shown; @param tabs where the choice is */
  constructor(private readonly root: HTMLElement, private readonly view3d: HTMLElement, tabs: HTMLElement, private readonly session: Session) {
    this.tabs = TABS.map(([shown, text, title]) => {
      const b = button(text, () => this.show(shown));
      b.title = title;
      return b;
    });
    tabs.append(...this.tabs);
    root.append(this.views.ultrasound, this.views.xray, this.knobs.ultrasound, this.knobs.xray, this.note);
    this.ultrasound = new UltrasoundView(this.views.ultrasound, session);
    new XrayView(this.views.xray, session);
    this.arrays = [
      ['transverse', keyButton('Transverse', 'T', 'Across the probe', () => this.show('transverse'))],
      ['sagittal', keyButton('Sagittal', 'S', 'Along the probe', () => this.show('sagittal'))],
    ];
    this.steps = [
      keyButton('◀', '[', 'One click of the stepper to inferior', () => this.step(-1)),
      keyButton('▶', ']', 'One click of the stepper to superior', () => this.step(1)),
    ];
    this.freeze = keyButton('Freeze', 'F', 'Keep this picture', () => this.toggleFreeze());
    this.freeze.setAttribute('aria-pressed', 'false');
    this.build();
    this.ultrasound.onPointer = (text) => (this.pointer.textContent = text);
    const write = onRepaintEvery(WRITE_EVERY_MS, () => this.write());
    for (const topic of ['image', 'status', 'link'] as const) session.on(topic, write);
    this.write();
  }

  private build(): void {
    const row = (...parts: HTMLElement[]) => {
      const r = element('div', 'row');
      r.append(...parts);
      return r;
    };
    const slider = (name: string, label: string, unit: string, low: number, high: number, step: number, title: string) => {
      this.sliders[name] = new Slider(label, unit, low, high, step, (value) => this.set(name, value), title);
      return this.sliders[name].row;
    };
    const tone = (label: string, unit: string, low: number, high: number, changed: (value: number) => void, start: number, title: string) => {
      const s = new Slider(label, unit, low, high, 1, (value) => {
        changed(value);
        this.ultrasound.box.request();
      }, title);
      s.set(start);
      return s.row;
    };
    const { ultrasound } = this;
    const template = toggle('Template', 'Draw the holes of the template over the transverse picture', (on) => (ultrasound.showTemplate = on));
    const truth = toggle('True position', 'Draw where needle and seeds truly are. Nobody sees this in a patient', (on) => (ultrasound.showTruth = on));
    for (const b of [template, truth]) b.addEventListener('click', () => ultrasound.box.request());
    this.knobs.ultrasound.append(
      row(...this.arrays.map(([, b]) => b)),
      element('h3', '', 'Stepper'), row(...this.steps), this.place, this.tracked,
      slider('probe.lift_mm', 'Lift', 'mm', -5, 20, 0.5, 'The probe to anterior, against the gland'),
      slider('probe.tilt_deg', 'Tilt', '°', -15, 15, 0.5, 'Positive: the end of the probe goes to anterior'),
      slider('probe.roll_deg', 'Roll', '°', -70, 70, 1, 'Turns the sagittal picture to the patient’s left'),
      slider('probe.balloon_mm', 'Balloon', 'mm', 0, 12, 0.5, 'Water between probe and wall'),
      element('h3', '', 'Picture'),
      tone('Gain', 'dB', -30, 30, (value) => (ultrasound.tone.gain_dB = value), 0, 'Brightness of all echoes'),
      tone('Range', 'dB', 30, 90, (value) => (ultrasound.tone.range_dB = value), 60, 'From black to white: small ranges show more contrast'),
      ...['TGC near', 'TGC 2', 'TGC 3', 'TGC far'].map((label, k) => tone(label, 'dB', -20, 20, (value) => (ultrasound.tone.tgc_dB[k] = value), 0, 'Time gain compensation: brightness by depth')),
      slider('ultrasound.depth_mm', 'Depth', 'mm', 40, 150, 5, 'Depth of the picture'),
      slider('ultrasound.focus_mm', 'Focus', 'mm', 10, 100, 5, 'Depth of the focus'),
      row(this.freeze, template), row(truth), this.pointer);
    const energy = element('div', 'row');
    for (const keV of [50, 80]) energy.append(button(`${keV} keV`, () => this.set('fluoroscopy.energy_keV', keV)));
    this.knobs.xray.append(
      element('h3', '', 'C-arm'),
      slider('fluoroscopy.angle_deg', 'Angle', '°', -90, 90, 1, 'About the patient; positive: the detector goes to the patient’s left'),
      slider('fluoroscopy.cranial_deg', 'Cranial', '°', -45, 45, 1, 'Positive: the detector goes to superior'),
      element('h3', '', 'Energy'), energy,
      element('p', 'quiet', 'Bones, needle and seeds are dark. Bladder and catheter hold contrast.'));
  }

  private get shown(): ShownImage {
    return this.session.status?.image?.shown ?? 'none';
  }

  /** Whether ultrasound is looked at; then T, S, F and the brackets are keys of the scanner. */
  get isUltrasound(): boolean {
    return this.shown === 'transverse' || this.shown === 'sagittal';
  }

  show(shown: ShownImage): void {
    this.ultrasound.freeze(false);
    this.session.command({ do: 'image', show: shown });
  }

  step(by: -1 | 1): void {
    const probe = this.probe();
    if (probe) this.set('probe.depth_mm', probe.depth_mm + by * probe.step_mm);
  }

  toggleFreeze(): void {
    this.ultrasound.freeze(!this.ultrasound.isFrozen);
    this.write();
  }

  private probe(): ProbeState | null {
    return this.session.image?.probe ?? null;
  }

  private set(key: string, value: number): void {
    this.wanted.set(key, value);
    this.send();
  }

  /** Says that a tracker moves the probe, and where the probe does not do what the tracker says. */
  private writeTracked(device: string, problem: string): void {
    const isTracked = device !== 'page';
    const text = isTracked ? `The probe follows ${device}. ${problem}` : '';
    if (this.tracked.textContent !== text) this.tracked.textContent = text;
    this.tracked.hidden = !isTracked;
    for (const name of ['lift_mm', 'tilt_deg', 'roll_deg']) this.sliders[`probe.${name}`].disabled = isTracked;
    for (const b of this.steps) b.disabled = isTracked;
  }

  private write(): void {
    const { session, shown } = this;
    const { image } = session;
    const problem = session.status?.image?.problem ?? '';
    const picture = shown === 'none' ? 'none' : shown === 'xray' ? 'xray' : 'ultrasound';
    this.root.hidden = picture === 'none';
    this.view3d.hidden = picture !== 'none';
    this.tabs.forEach((b, k) => {
      b.setAttribute('aria-pressed', String(TABS[k][0] === 'none' ? picture === 'none' : TABS[k][0] === 'xray' ? picture === 'xray' : picture === 'ultrasound'));
      b.disabled = !session.steering && !session.replaying;
    });
    for (const name of ['ultrasound', 'xray'] as const) {
      this.views[name].hidden = picture !== name;
      this.knobs[name].hidden = picture !== name;
    }
    const note = problem || (session.status?.image?.stage ? `${session.status.image.stage}.` : '');
    if (this.note.textContent !== note) this.note.textContent = note;
    this.note.hidden = note === '';
    for (const [array, b] of this.arrays) b.setAttribute('aria-pressed', String(array === shown));
    this.freeze.setAttribute('aria-pressed', String(this.ultrasound.isFrozen));
    this.writeTracked(session.status?.image?.probe_device ?? 'page', session.status?.image?.probe_problem ?? '');
    const probe = this.probe();
    if (probe) {
      const force = probe.force_N === null ? 'not pressing' : `${probe.force_N.toFixed(1)} N on the wall`;
      this.place.title = probe.force_N === null ? 'The scenario has no [probe]. With probe.kind = "biplane" the probe presses wall and gland' : 'Force of wall and gland on the probe';
      this.place.textContent = `z ${probe.depth_mm.toFixed(1).replace('-', '−')} mm, ${force}`;
      for (const name of ['lift_mm', 'tilt_deg', 'roll_deg', 'balloon_mm'] as const) this.sliders[`probe.${name}`].set(probe[name]);
    }
    if (image?.modality === 'ultrasound') {
      this.sliders['ultrasound.depth_mm'].set(image.depth_mm);
      this.sliders['ultrasound.focus_mm'].set(image.focus_mm);
    }
    if (image?.modality === 'xray') {
      this.sliders['fluoroscopy.angle_deg'].set(image.angle_deg);
      this.sliders['fluoroscopy.cranial_deg'].set(image.cranial_deg);
    }
  }
}
