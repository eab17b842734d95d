// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of the template's holes: clearances of the straight way, and results of a simulated needle through each hole.
import { button, element } from '../../../shared/dom';
import { colorsOf, isKnown, MEASURES, NEAREST, scaleEnd, scaleGradient, scaleWords, tellOf, type Measure } from '../../../shared/hole_map';
import { svg } from '../../../shared/svg';
import type { Session } from '../session';

const CHOICES = [NEAREST, ...MEASURES];

export class TemplateMap {
  private readonly choice = element('select');
  private readonly strip = element('div', 'strip');
  private readonly ends = [element('span'), element('span')];
  private readonly scale = element('div', 'colorbar map-scale');
  private readonly state = element('output', 'map-state');
  private readonly ask = button('', () => this.toggle());
  private marks = new Map<string, { group: SVGGElement; title: SVGTitleElement; name: string }>();

  constructor(root: HTMLElement, private readonly session: Session) {
    this.choice.setAttribute('aria-label', 'What the colours of the holes mean');
    this.choice.append(new Option('no colours', ''));
    for (const measure of CHOICES) this.choice.append(new Option(measure.label, measure.key));
    this.choice.value = NEAREST.key;
    this.choice.addEventListener('change', () => this.paint());
    const ticks = element('div', 'ticks');
    ticks.append(...this.ends);
    this.scale.append(this.strip, ticks);
    const row = element('div', 'map-row');
    row.append(this.state, this.ask);
    root.append(this.choice, this.scale, row);
    for (const topic of ['map', 'status', 'link'] as const) session.on(topic, () => (topic === 'map' ? this.paint() : this.offer()));
    this.paint();
  }

  /** Sets the drawn holes, by name. */
  setHoles(marks: Map<string, { group: SVGGElement; title: SVGTitleElement; name: string }>): void {
    this.marks = marks;
    this.paint();
  }

  private toggle(): void {
    this.session.command({ do: 'predict', on: this.session.map?.predicting ? 0 : 1 });
  }

  private measure(): Measure | undefined {
    return CHOICES.find((m) => m.key === this.choice.value);
  }

  private paint(): void {
    const map = this.session.map?.map ?? null;
    const measure = map ? this.measure() : undefined;
    const end = map && measure ? scaleEnd(measure, map) : 0;
    const known = new Map(map?.holes.map((h) => [h.hole, h]) ?? []);
    for (const [name, { group, title, name: said }] of this.marks) {
      group.querySelectorAll('.mapped').forEach((e) => e.remove());
      const hole = known.get(name);
      title.textContent = hole ? tellOf(hole) : map ? `${said}\nThe straight path from this hole misses the gland.` : said;
      if (!hole || !measure) continue;
      const mm = measure.of(hole);
      const disc = svg('circle', { r: 0.46, class: mm === null ? 'mapped unknown' : 'mapped', fill: mm === null ? 'none' : colorsOf(measure, end, mm).fill });
      group.querySelector('.area')?.after(disc);
      if (measure.clearance && mm === 0) group.append(svg('path', { d: 'M -0.26 -0.26 L 0.26 0.26 M -0.26 0.26 L 0.26 -0.26', class: 'mapped through' }));
    }
    this.legend();
    this.offer();
  }

  private legend(): void {
    const map = this.session.map?.map;
    const measure = this.measure();
    this.choice.hidden = !map;
    this.scale.hidden = !map || !measure || !isKnown(measure, map);
    if (!map || !measure || this.scale.hidden) return;
    this.strip.style.background = scaleGradient(measure);
    const words = scaleWords(measure, scaleEnd(measure, map));
    this.ends[0].textContent = measure.clearance ? `✕ ${words[0]}` : words[0];
    this.ends[1].textContent = words[1];
  }

  /** Shows the state of the map and whether predictions can be requested. */
  private offer(): void {
    const live = this.session.map;
    const measure = this.measure();
    const total = live?.map?.holes.length ?? 0;
    const predicted = live?.predicted ?? 0;
    this.ask.hidden = !live?.map || predicted >= total;
    this.ask.textContent = live?.predicting ? 'Stop' : 'Predict shift';
    this.ask.title = 'Simulates an insertion through each hole in the background, to predict the shift of the gland and how far the tip is off its target';
    this.ask.disabled = !this.session.steering;
    this.state.textContent = live?.why_not ? 'No map, because there is no gland.'
      : live?.predicting ? `Hole ${predicted + 1} of ${total} …`
      : live?.map && measure && !isKnown(measure, live.map) ? (measure.clearance ? 'Not in this model.' : 'Not predicted yet.')
      : predicted > 0 && predicted < total ? `${predicted} of ${total} holes` : '';
    this.state.title = live?.why_not ?? '';
  }
}
