// SPDX-License-Identifier: GPL-3.0-or-later

/** Builds one part of the page. If that fails, a message is shown and the other parts still work. */
export function build(id: string, part: (element: HTMLElement) => void): void {
  const element = document.getElementById(id);
  if (!element) throw new Error(`The page has no element "${id}"`);
  try {
    part(element);
  } catch (error) {
    const note = document.createElement('p');
    note.className = 'note';
    note.textContent = `This part could not be shown: ${error instanceof Error ? error.message : String(error)}`;
    element.replaceChildren(note);
  }
}
