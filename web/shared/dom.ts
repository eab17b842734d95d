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
