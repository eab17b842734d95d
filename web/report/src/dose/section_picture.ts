// SPDX-License-Identifier: GPL-3.0-or-later
// One section: isodose lines, outlines of structures and sources near the plane, as an SVG picture in millimetres.
import { element, setSlider, slider } from '../../../shared/dom';
import { numberText } from '../../../shared/numbers';
import { add, svg as makeSvg } from '../../../shared/svg';
import { contourPath, contourPlanes, isAt, nearestPlane, snapped, type ContourPlane } from './contour_planes';
import type { DoseData, Level } from './data';
import { differenceImage } from './difference';
import { isolines, linePath, shapePath, slice, type Line } from './isolines';
import { dashOf } from './level_look';
import { inPicture, type Plane } from './planes';

export const NEAR_MM = 2.5;
const EDGE = 7;          // [mm] room around the picture for the scale
const TEXT = 3;          // [mm] height of letters

/** Draws more over the sources of a section at a height [mm] along the plane's normal. */
export type MoreMarks = (inside: SVGElement, plane: Plane, height: number) => void;

/** The window of the picture [mm]. */
interface Frame {
  left: number; top: number; size: number;
}

function frameOf(data: DoseData, plane: Plane): Frame {
  const [x, y] = inPicture(plane, data.centre_mm);
  return { left: x - data.half_mm, top: y - data.half_mm, size: 2 * data.half_mm };
}

/** Numbers every 10 or 20 mm along both edges, and the patient's directions. */
function drawScale(svg: SVGElement, plane: Plane, frame: Frame): void {
  const { left, top, size } = frame;
  const g = add(svg, 'g', { class: 'scale' });
  add(g, 'rect', { x: left, y: top, width: size, height: size });
  const every = size > 130 ? 20 : 10;
  for (let v = Math.ceil(left / every) * every; v <= left + size; v += every) {
    add(g, 'path', { d: `M${v} ${top + size}v1.2` });
    if (v > left + 3 && v < left + size - 3) add(g, 'text', { x: v, y: top + size + 4.6, 'text-anchor': 'middle' }, numberText(v));
  }
  for (let v = Math.ceil(top / every) * every; v <= top + size; v += every) {
    add(g, 'path', { d: `M${left} ${v}h-1.2` });
    add(g, 'text', { x: left - 2, y: v + 1, 'text-anchor': 'end' }, numberText(plane.up ? -v : v));
  }
  const { ends } = plane;
  const middle = [left + size / 2, top + size / 2];
  const letters = add(svg, 'g', { class: 'ends' });
  add(letters, 'text', { x: left + 2.6, y: middle[1] + 1.4 }, ends.left);
  add(letters, 'text', { x: left + size - 2.6, y: middle[1] + 1.4 }, ends.right);
  add(letters, 'text', { x: middle[0], y: top + 4.4 }, ends.top);
  add(letters, 'text', { x: middle[0], y: top + size - 2 }, ends.bottom);
}

/** The point of lines that lies farthest in a direction, well within the frame. */
function farthest(lines: Line[], [dx, dy]: [number, number], { left, top, size }: Frame): [number, number] | null {
  let best: [number, number] | null = null;
  for (const line of lines) {
    for (const [x, y] of line) {
      if (x < left + 10 || x > left + size - 10 || y < top + 6 || y > top + size - 6) continue;
      if (!best || x * dx + y * dy > best[0] * dx + best[1] * dy) best = [x, y];
    }
  }
  return best;
}

// Labels of different doses lie in different directions from the middle, so that they do not meet.
const DIRECTIONS: [number, number][] = [[0.75, -0.66], [-0.75, -0.66], [0.75, 0.66], [-0.75, 0.66]];

function drawDose(svg: SVGElement, data: DoseData, plane: Plane, height: number, frame: Frame): void {
  const cut = slice(data.dose, plane, height);
  if (!cut) return;
  const labels: { at: [number, number]; toward: [number, number]; level: Level }[] = [];
  data.levels.forEach((level, k) => {
    const lines = isolines(cut, level.dose_Gy);
    const g = add(svg, 'g', { class: level.main ? 'isodose main' : 'isodose', stroke: level.color });
    add(g, 'path', { d: linePath(lines), 'stroke-dasharray': dashOf(k) });
    const toward = DIRECTIONS[k % DIRECTIONS.length];
    const at = farthest(lines, toward, frame);
    if (at) labels.push({ at, toward, level });
  });
  const names = add(svg, 'g', { class: 'isodose-names' });
  for (const { at: [x, y], toward: [dx, dy], level } of labels) {
    add(names, 'text', { x: x + 1.6 * dx, y: y + 1 + 2 * dy, fill: level.color, 'text-anchor': dx > 0 ? 'start' : 'end' }, level.label);
  }
}

/**
 * Draws the structures: their contours where they have some in this plane, elsewhere what lies between.
 * @returns heights [mm] of the nearest contours of structures that have none in this plane
 */
function drawStructures(svg: SVGElement, data: DoseData, plane: Plane, height: number, planes: ContourPlane[][]): number[] {
  const nearest: number[] = [];
  data.structures.forEach((structure, k) => {
    const g = add(svg, 'g', { class: structure.background ? 'structure background' : 'structure', fill: structure.color, stroke: structure.color });
    if (structure.mask) {
      const near = nearestPlane(planes[k], height);
      const cut = slice(structure.mask, plane, height);
      const path = near && isAt(near, height) ? contourPath(near.contours, plane) : cut ? shapePath(cut, 0.5) : '';
      if (path) add(g, 'path', { d: path });
      if (path && near && !isAt(near, height)) nearest.push(near.height);
      return;
    }
    const { cloud_mm: cloud } = structure;
    for (let k = 0; k < cloud.length; k += 3) {
      if (Math.abs(cloud[k + plane.normal] - height) > 1) continue;
      const [x, y] = inPicture(plane, cloud, k);
      add(g, 'circle', { cx: x.toFixed(2), cy: y.toFixed(2), r: 0.35, stroke: 'none' });
    }
  });
  return [...new Set(nearest)].sort((a, b) => a - b);
}

/** Sources near the plane: capsules of their true size, seen along the plane's normal. */
function drawSources(svg: SVGElement, { sources }: DoseData, plane: Plane, height: number): number {
  const g = add(svg, 'g', { class: sources.temporary ? 'dwells' : 'seeds' });
  const thick = Math.max(sources.diameter_mm, 1.1);
  let shown = 0;
  for (let s = 0; s < sources.needles.length; s++) {
    if (Math.abs(sources.places_mm[3 * s + plane.normal] - height) > NEAR_MM) continue;
    shown++;
    const [x, y] = inPicture(plane, sources.places_mm, 3 * s);
    const [ax, ay] = inPicture(plane, sources.axes, 3 * s);
    const half = sources.temporary ? 0 : Math.max(0, (sources.length_mm - thick) / 2);
    const d = `M${(x - half * ax).toFixed(3)} ${(y - half * ay).toFixed(3)}L${(x + half * ax + 1e-3).toFixed(3)} ${(y + half * ay).toFixed(3)}`;
    add(g, 'path', { d, class: 'rim', 'stroke-width': thick + 0.6 });
    add(g, 'path', { d, 'stroke-width': thick });
  }
  return shown;
}

/** The middle of the view, or the plane of the target's contours nearest to it. */
function firstHeight(data: DoseData, plane: Plane, planes: ContourPlane[][]): number {
  const target = data.structures.findIndex((structure) => structure.region === 'prostate');
  const near = nearestPlane(target < 0 ? [] : planes[target], data.centre_mm[plane.normal]);
  return near && Math.abs(near.height - data.centre_mm[plane.normal]) < 5 ? near.height : data.centre_mm[plane.normal];
}

/** @param withDifference a map of the difference instead of the lines of equal dose */
export function buildSection(data: DoseData, plane: Plane, more: MoreMarks = () => undefined, withDifference = false): HTMLElement {
  const planes = data.structures.map((structure) => contourPlanes(structure, plane.normal));
  const allPlanes = planes.flat();
  const figure = element('figure', 'section-picture');
  const caption = element('figcaption');
  const frame = frameOf(data, plane);
  const { left, top, size } = frame;
  const svg = makeSvg('svg', { viewBox: `${left - EDGE} ${top - 1} ${size + EDGE + 1} ${size + EDGE}`, role: 'img', 'font-size': TEXT });
  const middle = data.centre_mm[plane.normal];
  const first = firstHeight(data, plane, planes);
  const clip = `clip-${plane.normal}${withDifference ? '-difference' : ''}`;
  let pending = false;
  const draw = (wanted: number) => {
    const height = snapped(allPlanes, wanted);
    pending = false;
    svg.replaceChildren();
    add(add(svg, 'clipPath', { id: clip }), 'rect', { x: left, y: top, width: size, height: size });
    const inside = add(svg, 'g', { 'clip-path': `url(#${clip})` });
    if (withDifference && data.difference) {
      const image = differenceImage(data.difference, plane, height);
      if (image) add(inside, 'image', { href: image.url, x: image.x, y: image.y, width: image.width, height: image.height, preserveAspectRatio: 'none' });
    }
    const nearest = drawStructures(inside, data, plane, height, planes);
    if (!withDifference) drawDose(inside, data, plane, height, frame);
    const shown = drawSources(inside, data, plane, height);
    more(inside, plane, height);
    const names = inside.querySelector('.isodose-names');
    if (names) inside.append(names);
    drawScale(svg, plane, frame);
    const kind = data.sources.temporary ? 'dwell position' : 'seed';
    const where = `${plane.moves} = ${numberText(Math.round(100 * height) / 100)} mm`;
    caption.replaceChildren(element('b', '', plane.name), element('span', '', `${where} · ${shown} ${kind}${shown === 1 ? '' : 's'} near`));
    if (nearest.length > 0) {
      const heights = nearest.map((mm) => numberText(Math.round(100 * mm) / 100)).join(', ');
      caption.append(element('span', 'between', `between planes of contours; nearest at ${plane.moves} = ${heights} mm`));
    }
    svg.setAttribute('aria-label', `${plane.name} section at ${where}`);
  };
  const place = slider(`Position of the ${plane.name.toLowerCase()} section`, '0.5', () => {
    if (pending) return;
    pending = true;
    requestAnimationFrame(() => draw(place.valueAsNumber));
  });
  setSlider(place, Math.round(middle - data.half_mm + 1), Math.round(middle + data.half_mm - 1), first);
  draw(first);
  figure.append(caption, svg, place);
  return figure;
}
