// SPDX-License-Identifier: GPL-3.0-or-later

export function element<K extends keyof HTMLElementTagNameMap>(tag: K, className = '', text = ''): HTMLElementTagNameMap[K] {
  const e = document.createElement(tag);
  if (className) e.className = className;
  if (text) e.textContent = text;
  return e;
}

export function button(text: string, action: () => void): HTMLButtonElement {
  const b = element('button', '', text);
  b.type = 'button';
  b.addEventListener('click', action);
  return b;
}

/** A button with its key beside its text. */
export function keyButton(text: string, key: string, title: string, action: () => void): HTMLButtonElement {
  const b = button('', action);
  b.append(text, ' ', element('kbd', '', key));
  b.title = title;
  return b;
}

/** A slider without range. @param changed called while it is moved */
export function slider(label: string, step: string, changed: (value: number) => void): HTMLInputElement {
  const input = element('input');
  input.type = 'range';
  input.step = step;
  input.setAttribute('aria-label', label);
  input.addEventListener('input', () => changed(input.valueAsNumber));
  return input;
}

/** Sets range and value of a slider. */
export function setSlider(input: HTMLInputElement, low: number | string, high: number | string, value: number): void {
  input.min = String(low);
  input.max = String(high);
  input.value = String(value);
}

/** A choice of one of several; the first is chosen at the start. */
export function radioButtons<Value>(name: string, choices: readonly (readonly [string, Value])[], set: (value: Value) => void): HTMLElement {
  const box = element('div', 'choice');
  choices.forEach(([text, value], i) => {
    const label = element('label');
    const input = element('input');
    input.type = 'radio';
    input.name = name;
    input.checked = i === 0;
    input.addEventListener('change', () => set(value));
    label.append(input, text);
    box.append(label);
  });
  return box;
}

/** A check box with its text. @param color of the swatch beside it; null: none */
export function switchOf(text: string, on: boolean, color: string | null, set: (on: boolean) => void): HTMLElement {
  const label = element('label');
  const box = element('input');
  box.type = 'checkbox';
  box.checked = on;
  box.addEventListener('change', () => set(box.checked));
  label.append(box);
  if (color) {
    const swatch = element('span', 'swatch');
    swatch.style.background = color;
    label.append(swatch);
  }
  label.append(text);
  return label;
}
