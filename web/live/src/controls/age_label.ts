// SPDX-License-Identifier: GPL-3.0-or-later
// Says over the page how old the picture is, where it is not new.
import { element } from '../../../shared/dom';
import { ageInWords } from '../picture_age';
import type { Session } from '../session';

const LOOK_EVERY_MS = 100;
const REWRITE_EVERY_MS = 500;  // faster, the number could not be read

export class AgeLabel {
  private readonly label = element('output', 'picture-age');
  private writtenAt = 0;

  constructor(root: HTMLElement, private readonly session: Session) {
    this.label.hidden = true;
    root.append(this.label);
    setInterval(() => this.write(), LOOK_EVERY_MS);
  }

  private write(): void {
    const now = performance.now();
    const words = ageInWords(this.session, now);
    if (!this.label.hidden && now - this.writtenAt < REWRITE_EVERY_MS) return;
    if (words === '' && this.label.hidden) return;
    this.writtenAt = now;
    this.label.textContent = words;
    this.label.hidden = words === '';
  }
}
