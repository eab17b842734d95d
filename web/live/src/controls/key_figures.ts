// SPDX-License-Identifier: GPL-3.0-or-later
// The key figures of an insertion, in large numbers: peak force since the start, motion of the gland, and how far the
// tissue at the tip is off its target. A figure that is not known is a dash, and its title says why.
import { element } from '../../../shared/dom';
import { GlandFit, length } from '../gland_fit';
import { onRepaintEvery } from '../../../shared/repaint';
import type { Session } from '../session';
import { hasTipError, isDrawnBack } from '../tip_error';
import { SAMPLE_WORDS, type Frame, type Status } from '../wire';

const WRITE_EVERY_MS = 100;
const AXIAL = 2;  // index of the axial force in a sample

/** A figure as text, and an explanation of it. */
interface Said { text: string; title: string }

class Figure {
  readonly box = element('div', 'figure');
  private readonly number = element('b');

  constructor(caption: string, unit: string) {
    const value = element('div');
    value.append(this.number, element('span', 'unit', unit));
    this.box.append(element('span', 'name', caption), value);
  }

  set({ text, title }: Said): void {
    if (this.number.textContent !== text) this.number.textContent = text;
    if (this.box.title !== title) this.box.title = title;
  }
}

/**
 * The largest absolute axial force [N] of the steps of a frame and of all steps before.
 * @param peak largest absolute axial force of the steps before
 */
export function peakAfter(peak: number, { samples, whole }: Frame): number {
  let largest = whole ? 0 : peak;
  for (let i = 0; i < samples.length; i += SAMPLE_WORDS) largest = Math.max(largest, Math.abs(samples[i + AXIAL]));
  return largest;
}

function part(value: number, digits: number, unit: string, positive: string, negative: string): string {
  return `${Math.abs(value).toFixed(digits)}${unit} ${value < 0 ? negative : positive}`;
}

const unknown = (why: string): Said => ({ text: '–', title: `Not known: ${why}` });
const NO_PICTURE = 'no picture of the needle has arrived yet';

/** How far the tissue at the tip is off its target [mm]. */
export function tipErrorText(frame: Frame | null): Said {
  if (!frame) return unknown(NO_PICTURE);
  if (frame.replayed) return unknown('a recording does not say which tissue the tip is in');
  if (!hasTipError(frame)) return unknown('the tip is not in the tissue');
  const [lr, ap, si] = frame.tipError;
  const miss = 'The tissue at the tip lies, in the patient at rest, beside the place that a rigid straight needle would reach: ' +
    [part(si, 2, ' mm', 'superior', 'inferior'), part(ap, 2, ' mm', 'posterior', 'anterior'), part(lr, 2, ' mm', 'left', 'right')].join(', ');
  const when = isDrawnBack(frame) ? `This is the error at the deepest point, at a depth of ${frame.tipErrorDepth.toFixed(1)} mm; the needle has been drawn back since`
                                  : 'It is not the error of a seed: that lies in front of the tip, where the needle drags the tissue along less';
  return { text: length([lr, ap, si]).toFixed(2), title: `${miss}. ${when}.` };
}

/** How far a seed that is pushed out now would rest from its place [mm]. */
export function seedText(frame: Frame | null, status: Pick<Status, 'seed_off_mm'> | null): Said {
  if (!frame) return unknown(NO_PICTURE);
  if (frame.replayed) return unknown('it is computed for a live needle only');
  if (!hasTipError(frame)) return unknown('the tip is not in the tissue');
  const off = status?.seed_off_mm;
  if (off == null) return unknown('the motion of the tissue in front of the tip has not been found');
  return { text: off.toFixed(1), title: 'A seed that is pushed out of the tip now would rest, with all needles out, so far from the place at which a rigid straight needle leaves it in a patient that nothing has moved' };
}

/** Shift [mm] and turn [degrees] of the gland. @param gland null: no displacement has arrived since the scene did */
export function glandTexts(gland: Pick<GlandFit, 'shift' | 'rotation'> | null, status: Pick<Status, 'stage'> | null): { shift: Said; turn: Said } {
  if (!gland) {
    const why = unknown(`the motion of the tissue is still being prepared${status?.stage ? ` (${status.stage})` : ''}`);
    return { shift: why, turn: why };
  }
  const { shift: [lr, ap, si], rotation: [sagittal, coronal, transverse] } = gland;
  return {
    shift: {
      text: length([lr, ap, si]).toFixed(2),
      title: 'Mean shift of the drawn surface of the gland (a report gives the shift averaged over its volume, which is up to a fifth larger): ' +
        [part(si, 2, ' mm', 'superior', 'inferior'), part(ap, 2, ' mm', 'posterior', 'anterior'), part(lr, 2, ' mm', 'left', 'right')].join(', '),
    },
    turn: {
      text: length([sagittal, coronal, transverse]).toFixed(1),
      title: 'Rigid rotation of the gland’s surface: ' +
        [part(coronal, 2, '° coronal, base to the', 'left', 'right'), part(sagittal, 2, '° sagittal, base to', 'anterior', 'posterior'),
         part(transverse, 2, '° transverse, left side to', 'posterior', 'anterior')].join('; '),
    },
  };
}

/** The peak force [N]. @param largest of the steps that have arrived */
export function peakText(largest: number, frame: Frame | null): Said {
  return frame ? { text: largest.toFixed(2), title: 'Largest absolute axial force since the start of this insertion' } : unknown(NO_PICTURE);
}

export class KeyFigures {
  private readonly peak = new Figure('Peak force', 'N');
  private readonly shift = new Figure('Gland shift', 'mm');
  private readonly turn = new Figure('Gland turn', '°');
  private readonly tip = new Figure('Tip off its target', 'mm');
  private readonly seed = new Figure('A seed dropped here rests off by', 'mm');
  private largest = 0;  // [N] peak force
  private gland: GlandFit | null = null;
  private hasMoved = false;  // a displacement has arrived, so that the gland's motion is known

  constructor(root: HTMLElement, private readonly session: Session) {
    this.seed.box.classList.add('wide');
    root.append(this.peak.box, this.shift.box, this.turn.box, this.tip.box, this.seed.box);
    const write = onRepaintEvery(WRITE_EVERY_MS, () => this.write());
    session.on('scene', (scene) => {
      this.gland = GlandFit.of(scene);
      this.hasMoved = false;
      this.shift.box.hidden = this.turn.box.hidden = this.gland === null;
      write();
    });
    session.on('status', write);
    session.on('restart', () => {
      this.largest = 0;
      write();
    });
    session.on('frame', (frame) => {
      this.largest = peakAfter(this.largest, frame);
      if (frame.shown) {
        this.gland?.update(frame.displacement, frame.unit);
        this.hasMoved = true;
      }
      write();
    });
  }

  private write(): void {
    const { frame, status } = this.session;
    this.peak.set(peakText(this.largest, frame));
    this.tip.set(tipErrorText(frame));
    this.seed.set(seedText(frame, status));
    if (!this.gland) return;
    const { shift, turn } = glandTexts(this.hasMoved ? this.gland : null, status);
    this.shift.set(shift);
    this.turn.set(turn);
  }
}
