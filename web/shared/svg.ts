// SPDX-License-Identifier: GPL-3.0-or-later
const SVG = 'http://www.w3.org/2000/svg';

/** An SVG element with its attributes. */
export function svg<K extends keyof SVGElementTagNameMap>(tag: K, attributes: Record<string, string | number>): SVGElementTagNameMap[K] {
  const e = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, String(value));
  return e;
}

/** The same at the end of another element. */
export function add<K extends keyof SVGElementTagNameMap>(parent: Element, tag: K, attributes: Record<string, string | number>, text = ''): SVGElementTagNameMap[K] {
  const e = svg(tag, attributes);
  e.textContent = text;
  parent.append(e);
  return e;
}
