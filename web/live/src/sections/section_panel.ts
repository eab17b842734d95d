// SPDX-License-Identifier: GPL-3.0-or-later
// A section with its title and the controls of its plane.
import { button, element, setSlider, slider } from '../../../shared/dom';
import type { Session } from '../session';
import { onRepaint } from '../../../shared/repaint';
import type { Plane } from './plane';
import { SectionView } from './section_view';
import { wheelNotches } from '../wheel';

const NOTCH_MM = 1;

export class SectionPanel {
  readonly view: SectionView;
  private readonly slider: HTMLInputElement;
  private readonly place = element('output');
  private readonly follow: HTMLButtonElement;

  constructor(root: HTMLElement, session: Session, private readonly plane: Plane, other: Plane) {
    const transverse = plane.name === 'transverse';
    const head = element('div', 'section-head');
    const picture = element('div', 'canvas');
    head.append(element('h2', '', this.title), this.place);
    this.slider = slider(`Place of the ${plane.name} plane`, '0.5', (value) => plane.set(value));
    this.follow = button(transverse ? 'Follow tip' : 'Follow hole', () => plane.follow(!plane.follows));
    head.append(this.slider, this.follow);
    root.append(head, picture);
    this.view = new SectionView(picture, session, plane, other);
    picture.addEventListener('wheel', (e) => {
      if (e.ctrlKey) return;
      e.preventDefault();
      plane.set(plane.value + wheelNotches(e) * NOTCH_MM);
    }, { passive: false });
    plane.onChange(onRepaint(() => this.update()));
    this.update();
  }

  get title(): string {
    return this.plane.name === 'transverse' ? 'Transverse' : 'Sagittal';
  }

  private update(): void {
    const { plane } = this;
    setSlider(this.slider, plane.low.toFixed(1), plane.high.toFixed(1), plane.value);
    this.place.textContent = `${plane.axis === 2 ? 'z' : 'x'} = ${plane.value.toFixed(1).replace('-', '−')} mm`;
    this.follow.setAttribute('aria-pressed', String(plane.follows));
  }
}
