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
