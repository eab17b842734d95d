// SPDX-License-Identifier: GPL-3.0-or-later
// Controls of the plane that cuts the anatomy open in the 3D view.
import { element, setSlider, slider } from '../../../shared/dom';
import { organBounds, type Scene } from '../scene';
import type { Stage } from './stage';

const PLANES = [
  { name: 'None', axis: null, side: 1 },
  { name: 'Sagittal', axis: 0, side: 1 },   // removes the left half, because the oblique view is from the left
  { name: 'Coronal', axis: 1, side: -1 },
  { name: 'Transverse', axis: 2, side: 1 },
] as const;

export class CutControl {
  readonly element = element('div', 'cut');
  private chosen: (typeof PLANES)[number] = PLANES[0];
  private readonly slider = slider('Place of the cut', '0.5', (value) => {
    if (this.chosen.axis !== null) this.values[this.chosen.axis] = value;
    this.apply();
  });
  private readonly text = element('output');
  private values = [0, 0, 0];

  constructor(private readonly stage: Stage) {
    const choice = element('select');
    choice.setAttribute('aria-label', 'Plane that cuts the anatomy open');
    for (const plane of PLANES) choice.append(new Option(plane.name));
    choice.addEventListener('change', () => {
      this.chosen = PLANES[choice.selectedIndex];
      this.setRange();
      this.apply();
    });
    this.slider.disabled = true;
    this.element.append(choice, this.slider, this.text);
  }

  setScene(scene: Scene): void {
    this.bounds = organBounds(scene);
    this.values = scene.insertions[0]?.entry_mm.slice() ?? this.bounds.map(([low, high]) => (low + high) / 2);
    this.values[2] = (this.bounds[2][0] + this.bounds[2][1]) / 2;
    this.setRange();
    this.apply();
  }

  private bounds: [number, number][] = [[-50, 50], [-50, 50], [-50, 50]];

  private setRange(): void {
    const { axis } = this.chosen;
    this.slider.disabled = axis === null;
    if (axis === null) return;
    setSlider(this.slider, Math.floor(this.bounds[axis][0]), Math.ceil(this.bounds[axis][1]), this.values[axis]);
  }

  private apply(): void {
    const { axis, side } = this.chosen;
    const value = axis === null ? 0 : this.values[axis];
    this.text.textContent = axis === null ? '' : `${'xyz'[axis]} = ${value.toFixed(1)} mm`;
    this.stage.cut.place(axis, value, side);
    this.stage.draw();
  }
}
