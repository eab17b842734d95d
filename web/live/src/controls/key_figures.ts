// SPDX-License-Identifier: GPL-3.0-or-later
// The key figures of an insertion, in large numbers: peak force since the start, motion of the gland, and tip error.
import { element } from '../../../shared/dom';
import { GlandFit, length } from '../gland_fit';
import { onRepaintEvery } from '../../../shared/repaint';
import type { Session } from '../session';
import { hasTipError, isDrawnBack } from '../tip_error';
import { SAMPLE_WORDS, type Frame } from '../wire';

const WRITE_EVERY_MS = 100;
const AXIAL = 2;  // index of the axial force in a sample

class Figure {
  readonly box = element('div', 'figure');
  private readonly number = element('b');

  constructor(caption: string, unit: string) {
    const value = element('div');
    value.append(this.number, element('span', 'unit', unit));
    this.box.append(element('span', 'name', caption), value);
  }

  set(text: string, title: string): void {
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

/** The tip error [mm] as text, and an explanation of it. */
export function tipErrorText(frame: Frame): { text: string; title: string } {
  if (!hasTipError(frame)) return { text: '–', title: 'The tip is not in the tissue' };
  const [lr, ap, si] = frame.tipError;
  const miss = 'Position of the tip in the tissue minus the position that a rigid straight needle would reach in the undeformed patient: ' +
    [part(si, 2, ' mm', 'superior', 'inferior'), part(ap, 2, ' mm', 'posterior', 'anterior'), part(lr, 2, ' mm', 'left', 'right')].join(', ');
  const when = isDrawnBack(frame) ? `This is the error at the deepest point, at a depth of ${frame.tipErrorDepth.toFixed(1)} mm; the needle has been drawn back since`
                                  : 'A seed dropped now would miss its planned place in the tissue by about this distance';
  return { text: length([lr, ap, si]).toFixed(2), title: `${miss}. ${when}.` };
}

export class KeyFigures {
  private readonly peak = new Figure('Peak force', 'N');
  private readonly shift = new Figure('Gland shift', 'mm');
  private readonly turn = new Figure('Gland turn', '°');
  private readonly tip = new Figure('Tip error', 'mm');
  private largest = 0;  // [N] peak force
  private gland: GlandFit | null = null;

  constructor(root: HTMLElement, private readonly session: Session) {
    root.append(this.peak.box, this.shift.box, this.turn.box, this.tip.box);
    const write = onRepaintEvery(WRITE_EVERY_MS, () => this.write());
    session.on('scene', (scene) => {
      this.gland = GlandFit.of(scene);
      this.shift.box.hidden = this.turn.box.hidden = this.gland === null;
      write();
    });
    session.on('restart', () => {
      this.largest = 0;
      write();
    });
    session.on('frame', (frame) => {
      this.largest = peakAfter(this.largest, frame);
      if (frame.shown) this.gland?.update(frame.displacement, frame.unit);
      write();
    });
  }

  private write(): void {
    this.peak.set(this.largest.toFixed(2), 'Largest absolute axial force since the start of this insertion');
    const { frame } = this.session;
    this.tip.box.hidden = frame?.replayed ?? false;  // recordings do not contain it
    if (frame) {
      const { text, title } = tipErrorText(frame);
      this.tip.set(text, title);
    }
    if (!this.gland) return;
    const { shift: [lr, ap, si], rotation: [sagittal, coronal, transverse] } = this.gland;
    this.shift.set(length([lr, ap, si]).toFixed(2), 'Mean shift of the drawn surface of the gland (a report gives the shift averaged over its volume, which is up to a fifth larger): ' +
      [part(si, 2, ' mm', 'superior', 'inferior'), part(ap, 2, ' mm', 'posterior', 'anterior'), part(lr, 2, ' mm', 'left', 'right')].join(', '));
    this.turn.set(length([sagittal, coronal, transverse]).toFixed(1), 'Rigid rotation of the gland’s surface: ' +
      [part(coronal, 2, '° coronal, base to the', 'left', 'right'), part(sagittal, 2, '° sagittal, base to', 'anterior', 'posterior'),
       part(transverse, 2, '° transverse, left side to', 'posterior', 'anterior')].join('; '));
  }
}
