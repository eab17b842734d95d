// SPDX-License-Identifier: GPL-3.0-or-later
// The guide template, seen from the feet. A click on a hole puts the needle there. Arrow keys move between the holes.
import { element } from '../../../shared/dom';
import { svg } from '../../../shared/svg';
import { holes, type Hole, type Scene } from '../scene';
import type { Session } from '../session';
import type { HandControl } from '../hand';
import { TemplateMap } from './template_map';

export class TemplatePicker {
  private readonly title = element('div', 'picker-title');
  private readonly grid = element('div', 'picker-grid');
  private readonly map: TemplateMap;
  private list: { hole: Hole; mark: SVGGElement }[] = [];
  private columns = 0;
  private focused = 0;

  constructor(root: HTMLElement, private readonly session: Session, private readonly hand: HandControl) {
    const key = element('div', 'picker-key');
    for (const [kind, text] of [['planned', 'planned'], ['needle', 'needle'], ['taken', 'stays']]) {
      const item = element('span', `of-${kind}`);
      item.append(element('i', kind), text);
      key.append(item);
    }
    const taken = key.querySelector('.of-taken') as HTMLElement;
    taken.hidden = true;
    const hint = element('p', 'picker-hint',
      'Wheel over the 3D view or ↑ pushes. A click on a hole moves the needle there. ? lists all keys.');
    const colors = element('div', 'picker-map');
    this.map = new TemplateMap(colors, session);
    root.append(this.title, this.grid, key, colors, hint);
    session.on('scene', (scene) => {
      taken.hidden = scene.stabilising.length === 0;
      this.build(scene);
    });
    session.on('status', () => {
      hint.hidden = session.guest !== '';  // the page cannot push then
      this.mark();
    });
    this.mark();
  }

  private build(scene: Scene): void {
    this.list = [];
    this.grid.replaceChildren();
    const { template } = scene;
    if (!template) {
      this.grid.append(element('p', 'quiet', 'This case has no template.'));
      this.map.setHoles(new Map());
      return;
    }
    const { columns, rows } = template;
    this.columns = columns.length;
    const [w, h] = [columns.length + 1.2, rows.length + 1.2];
    const picture = svg('svg', { viewBox: `0 0 ${w} ${h}`, preserveAspectRatio: 'xMidYMin meet', role: 'grid', 'aria-label': 'Holes of the template' });
    const x = (i: number) => i + 1.5;
    const y = (j: number) => rows.length - 1 - j + 0.6;
    columns.forEach((name, i) => {
      const label = svg('text', { x: x(i), y: h - 0.2, class: /[a-z]/.test(name) ? 'half' : '' });
      label.textContent = name;
      picture.append(label);
    });
    rows.forEach((name, j) => {
      if (name.includes('.')) return;
      const label = svg('text', { x: 0.5, y: y(j) + 0.26 });
      label.textContent = name;
      picture.append(label);
    });
    const marks = new Map<string, { group: SVGGElement; title: SVGTitleElement; name: string }>();
    const planned = new Map(scene.insertions.map((insertion) => [insertion.hole, insertion.name]));
    for (const hole of holes(template)) {
      const mark = svg('g', { class: 'hole', role: 'gridcell', tabindex: -1, transform: `translate(${x(hole.column)} ${y(hole.row)})` });
      const isPlanned = planned.has(hole.name);
      const isTaken = scene.stabilising.includes(hole.name);
      const more = isTaken ? ', a needle stays in it' : isPlanned ? ', planned' : '';
      mark.setAttribute('aria-label', `Hole ${hole.name}${more}`);
      mark.append(svg('rect', { x: -0.5, y: -0.5, width: 1, height: 1, class: 'area' }));
      if (isPlanned) mark.append(svg('circle', { r: 0.44, class: 'planned' }));
      if (isTaken) mark.append(svg('circle', { r: 0.3, class: 'taken' }));
      const whole = hole.column % 2 === 0 && hole.row % 2 === 0;
      mark.append(svg('circle', { r: whole ? 0.2 : 0.13, class: 'dot' }));
      const title = svg('title', {});
      title.textContent = hole.name + more;
      mark.append(title);
      marks.set(hole.name, { group: mark, title, name: title.textContent });
      const number = this.list.length;
      mark.addEventListener('click', () => this.choose(number));
      mark.addEventListener('keydown', (e) => this.key(e));
      this.list.push({ hole, mark });
      picture.append(mark);
    }
    this.grid.append(picture);
    this.map.setHoles(marks);
    this.mark();
  }

  private choose(number: number): void {
    const { session } = this;
    const { hole } = this.list[number];
    if (!session.steering) {
      session.notify('You do not hold the needle.', 'Ask for the needle first.');
      return;
    }
    this.hand.rest();
    session.command({ do: 'hole', hole: hole.name });
  }

  private key(e: KeyboardEvent): void {
    const rows = this.list.length / this.columns;
    const move: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (e.key === 'Enter') this.choose(this.focused);
    else if (e.key in move && !e.shiftKey) {
      const { column, row } = this.list[this.focused].hole;
      const i = Math.max(0, Math.min(this.columns - 1, column + move[e.key][0]));
      const j = Math.max(0, Math.min(rows - 1, row + move[e.key][1]));
      this.focus(j * this.columns + i);
      this.list[this.focused].mark.focus();
    } else return;
    e.preventDefault();
    e.stopPropagation();
  }

  private focus(number: number): void {
    this.list[this.focused]?.mark.setAttribute('tabindex', '-1');
    this.focused = number;
    this.list[number]?.mark.setAttribute('tabindex', '0');
  }

  private shown = '';

  private mark(): void {
    const { status, scene } = this.session;
    const current = status?.hole ?? '';
    const key = `${current} ${scene?.case} ${this.list.length}`;
    if (key === this.shown) return;
    this.shown = key;
    this.title.textContent = current ? `Template, needle in ${current}` : 'Template';
    this.list.forEach(({ hole, mark }, i) => {
      mark.classList.toggle('current', hole.name === current);
      mark.setAttribute('aria-selected', String(hole.name === current));
      if (hole.name === current) this.focus(i);
    });
    if (!current && this.list.length > 0) this.focus(0);
  }
}
