// SPDX-License-Identifier: GPL-3.0-or-later
// Figure 2 as SVG: contours slice by slice, the organ's surface, and needle segments. The solids can be turned.
import { numberText } from '../../../shared/numbers';
import { add, svg } from '../../../shared/svg';
import { BLUE, VERMILION } from './colors';
import type { Figure2, Point, Segment } from './data';

/**
 * Draws each contour in a picture of its own, from the apex to the base, seen from the feet: the patient's left is
 * right.
 */
export function drawContours(box: HTMLElement, figure: Figure2): void {
  const all = figure.contours.flatMap((c) => c.points_mm);
  const xs = all.map((p) => p[0]);
  const ys = all.map((p) => p[1]);
  const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const margin = 2.5;
  const grid = document.createElement('div');
  grid.className = 'slices';
  for (const { points_mm: points, kept } of figure.contours) {
    const panel = document.createElement('div');
    const view = svg('svg', {
      viewBox: `${left - margin} ${top - margin} ${right - left + 2 * margin} ${bottom - top + 2 * margin}`,
      role: 'img', 'aria-label': `Contour at z = ${numberText(points[0][2], 0)} mm`,
    });
    const closed = (chosen: Point[]) => chosen.map((p) => `${p[0].toFixed(2)},${p[1].toFixed(2)}`).join(' ');
    add(view, 'polygon', { points: closed(points), fill: '#f4f5f7', stroke: 'none' });
    add(view, 'polygon', { points: closed(points.filter((_, i) => kept[i])), fill: 'none', stroke: BLUE, 'stroke-width': 0.35 });
    points.forEach((p, i) => {
      if (!kept[i]) add(view, 'circle', { cx: p[0], cy: p[1], r: 0.5, fill: '#fff', stroke: VERMILION, 'stroke-width': 0.28 });
    });
    points.forEach((p, i) => {
      if (kept[i]) add(view, 'circle', { cx: p[0], cy: p[1], r: 0.8, fill: BLUE });
    });
    const caption = document.createElement('span');
    caption.textContent = `z = ${numberText(points[0][2], 0)} mm: ${kept.filter((k) => k).length} of ${points.length}`;
    panel.append(view, caption);
    grid.append(panel);
  }
  box.append(grid);
}

type Mat = [Point, Point, Point];  // rows: right, up, towards the observer

/** Camera of an observer at azimuth a around the z axis and elevation b [rad]. */
function camera(a: number, b: number): Mat {
  const towards: Point = [Math.cos(b) * Math.sin(a), -Math.cos(b) * Math.cos(a), Math.sin(b)];
  const right: Point = [Math.cos(a), Math.sin(a), 0];
  const up: Point = [-Math.sin(b) * Math.sin(a), Math.sin(b) * Math.cos(a), Math.cos(b)];
  return [right, up, towards];
}

const dot = (a: Point, b: Point) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a: Point, b: Point): Point => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a: Point, b: Point): Point => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

interface Solid {
  points: Point[];
  triangles: [number, number, number][];  // outward normals
  edges: [number, number][];              // inner edges, visible through the translucent faces
  color: [number, number, number];
  opacity: number;
  turn: [number, number];  // [rad] azimuth and elevation at the start
}

/** Draws a solid with flat shading; dragging turns it. */
function drawSolid(box: HTMLElement, solid: Solid, label: string): void {
  const { points } = solid;
  const centre = [0, 1, 2].map((k) => points.reduce((s, p) => s + p[k], 0) / points.length) as Point;
  const local = points.map((p) => minus(p, centre));
  const radius = Math.max(...local.map((p) => Math.hypot(...p)));
  const view = svg('svg', { viewBox: `${-1.06 * radius} ${-1.06 * radius} ${2.12 * radius} ${2.12 * radius}`, role: 'img', 'aria-label': label });
  view.classList.add('solid');
  box.append(view);
  let [azimuth, lift] = solid.turn;
  const light: Point = [-0.35, 0.55, 0.76];
  const draw = () => {
    const rows = camera(azimuth, lift);
    const seen = local.map((p) => rows.map((row) => dot(row, p)) as Point);
    const faces = solid.triangles
      .map((t) => {
        const [a, b, c] = t.map((i) => seen[i]);
        const normal = cross(minus(b, a), minus(c, a));
        const length = Math.hypot(...normal) || 1;
        return { corners: [a, b, c], depth: a[2] + b[2] + c[2], n: normal.map((v) => v / length) as Point };
      })
      .filter((f) => solid.opacity < 1 || f.n[2] > 0)
      .sort((a, b) => a.depth - b.depth);
    view.replaceChildren();
    for (const { corners, n } of faces) {
      const shade = 0.55 + 0.45 * Math.max(0, dot(n, light));
      const fill = `rgb(${solid.color.map((c) => Math.round(c * shade)).join(',')})`;
      add(view, 'polygon', {
        points: corners.map((p) => `${p[0].toFixed(3)},${(-p[1]).toFixed(3)}`).join(' '),
        fill, 'fill-opacity': solid.opacity, stroke: '#23262b', 'stroke-opacity': 0.55, 'stroke-width': radius / 220, 'stroke-linejoin': 'round',
      });
    }
    for (const [a, b] of solid.edges) {
      add(view, 'line', { x1: seen[a][0], y1: -seen[a][1], x2: seen[b][0], y2: -seen[b][1], stroke: BLUE, 'stroke-width': radius / 110 });
    }
    if (solid.edges.length > 0) {
      for (const p of seen) add(view, 'circle', { cx: p[0], cy: -p[1], r: radius / 45, fill: BLUE, stroke: '#fff', 'stroke-width': radius / 260 });
    }
  };
  let held: [number, number] | null = null;
  view.addEventListener('pointerdown', (e) => {
    held = [e.clientX, e.clientY];
    view.setPointerCapture(e.pointerId);
  });
  view.addEventListener('pointermove', (e) => {
    if (!held) return;
    azimuth -= (e.clientX - held[0]) * 0.01;
    lift = Math.max(-1.5, Math.min(1.5, lift + (e.clientY - held[1]) * 0.01));
    held = [e.clientX, e.clientY];
    draw();
  });
  view.addEventListener('pointerup', () => (held = null));
  draw();
}

export function drawSurface(box: HTMLElement, figure: Figure2): void {
  drawSolid(box, {
    points: figure.surface.points_mm,
    triangles: figure.surface.triangles,
    edges: [],
    color: [150, 196, 224],
    opacity: 1,
    turn: [0.7, 0.25],
  }, 'Surface of the organ, from the patient’s left front');
}

/** Draws the tetrahedra of a segment: outer faces and inner edges. */
export function drawSegment(box: HTMLElement, segment: Segment): void {
  const { points_mm: points, tets } = segment;
  const triangles = new Map<string, [number, number, number]>();
  const edges = new Map<string, [number, number]>();
  for (const [a, b, c, d] of tets) {
    for (const face of [[b, c, d], [a, d, c], [a, b, d], [a, c, b]] as [number, number, number][]) {
      const key = [...face].sort((x, y) => x - y).join();
      if (triangles.has(key)) triangles.delete(key);  // between two tetrahedra
      else triangles.set(key, face);
    }
    for (const [p, q] of [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]]) edges.set([Math.min(p, q), Math.max(p, q)].join(), [p, q]);
  }
  for (const [a, b, c] of triangles.values()) {
    for (const [p, q] of [[a, b], [b, c], [c, a]]) edges.delete([Math.min(p, q), Math.max(p, q)].join());
  }
  drawSolid(box, {
    points, triangles: [...triangles.values()], edges: [...edges.values()],
    color: [214, 221, 228], opacity: 0.55, turn: [0.6, 0.35],
  }, 'One segment of the needle, its axis upright');
}
