// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the guide template, seen from the patient's feet: one for each quantity of the map, with its numbers.
import { element } from '../../../shared/dom';
import { colorsOf, isKnown, MEASURES, scaleEnd, scaleGradient, scaleWords, shortText, tellOf, type HoleMap, type Measure } from '../../../shared/hole_map';
import { add, svg } from '../../../shared/svg';

function draw(map: HoleMap, measure: Measure): SVGSVGElement {
  const { columns, rows } = map;
  const picture = svg('svg', {
    viewBox: `0 0 ${columns.length + 1.2} ${rows.length + 1.2}`, class: 'template', role: 'img',
    'aria-label': `${measure.label} at each hole of the template; the table below has the numbers`,
  });
  const x = (i: number) => i + 1.5;
  const y = (j: number) => rows.length - 1 - j + 0.6;
  const label = (text: string, [left, down]: [number, number]) => add(picture, 'text', { x: left, y: down + 0.2, class: 'name' }, text);
  columns.forEach((name, i) => label(name, [x(i), rows.length + 0.45]));
  rows.forEach((name, j) => label(name, [0.5, y(j)]));
  const end = scaleEnd(measure, map);
  const byName = new Map(map.holes.map((h) => [h.hole, h]));
  rows.forEach((row, j) => columns.forEach((column, i) => {
    const mapped = byName.get(column + row);
    if (!mapped) {
      const dot = add(picture, 'circle', { cx: x(i), cy: y(j), r: 0.09, class: 'missing' });
      add(dot, 'title', {}, `Hole ${column + row}: the straight path from this hole misses the gland`);
      return;
    }
    const mm = measure.of(mapped);
    const hole = add(picture, 'g', { transform: `translate(${x(i)} ${y(j)})` });
    const colors = mm === null ? { fill: 'none', text: '' } : colorsOf(measure, end, mm);
    add(hole, 'circle', { r: 0.46, fill: colors.fill, class: mm === null ? 'unknown' : 'known' });
    if (mapped.hole === map.planned) add(hole, 'rect', { x: -0.5, y: -0.5, width: 1, height: 1, class: 'planned' });
    add(hole, 'text', { y: 0.13, fill: colors.text, class: mm === null ? 'value unknown' : 'value' }, mm === null ? '–' : shortText(mm));
    add(hole, 'title', {}, tellOf(mapped));
  }));
  return picture;
}

function scale(map: HoleMap, measure: Measure): HTMLElement {
  const box = element('div', 'colorbar');
  const strip = element('div', 'strip');
  strip.style.background = scaleGradient(measure);
  const ticks = element('div', 'ticks');
  for (const words of scaleWords(measure, scaleEnd(measure, map))) ticks.append(element('span', '', words));
  box.append(strip, ticks);
  return box;
}

/** Fills the box with a picture for each quantity of the map. */
export function buildTemplatePictures(map: HoleMap, box: HTMLElement): void {
  for (const measure of MEASURES) {
    const figure = element('figure');
    figure.append(element('figcaption', '', `${measure.label} [mm]`));
    if (isKnown(measure, map)) figure.append(draw(map, measure), scale(map, measure));
    else figure.append(element('p', 'note', measure.clearance ? 'This model does not have the structure.' : 'No hole has a value of this quantity.'));
    box.append(figure);
  }
}
