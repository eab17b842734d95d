// SPDX-License-Identifier: GPL-3.0-or-later
// A made-up patient for tests of the page: ellipsoids in a box.
import type { Patch, Region, SceneText } from 'live/src/scene';

interface Ellipsoid { name: string; label: string; color: string; opacity: number; centre: [number, number, number]; half: [number, number, number] }

const SKIN_Z = -48;
const BODIES: Ellipsoid[] = [
  { name: 'prostate', label: 'Prostate', color: '#0072b2', opacity: 0.5, centre: [0, 0, 0], half: [23, 16, 20] },
  { name: 'bladder', label: 'Bladder', color: '#56b4e9', opacity: 0.4, centre: [0, -8, 42], half: [28, 22, 18] },
  { name: 'rectum', label: 'Rectum', color: '#cc79a7', opacity: 0.45, centre: [0, 29, 4], half: [12, 9, 38] },
  { name: 'pubic_arch', label: 'Pubic arch', color: '#e69f00', opacity: 0.7, centre: [0, -34, -4], half: [30, 8, 14] },
];
const BOX = { low: [-55, -50, SKIN_Z], high: [55, 50, 66] };

export interface MadeUpPatient { text: SceneText; points: Float32Array; corners: Uint32Array }

export function makePatient(): MadeUpPatient {
  const points: number[] = [];
  const corners: number[] = [];
  const patches: Patch[] = [];
  const regions: Region[] = [{ name: 'body', label: 'Body', color: '#a6761d', opacity: 0.08, target: false, background: true, volume_cc: 1254 }];
  addBox(points, corners);
  patches.push({ inside: 0, outside: -1, first: 0, count: corners.length / 3 });
  for (const body of BODIES) {
    const first = corners.length / 3;
    addEllipsoid(points, corners, body);
    patches.push({ inside: regions.length, outside: 0, first, count: corners.length / 3 - first });
    const volume = (4 / 3) * Math.PI * body.half[0] * body.half[1] * body.half[2] / 1000;
    regions.push({ name: body.name, label: body.label, color: body.color, opacity: body.opacity, target: body.name === 'prostate', background: false, spared: body.name === 'bladder' || body.name === 'rectum', volume_cc: volume });
  }
  const columns = [...'AaBbCcDdEeFfG'];
  const rows = Array.from({ length: 13 }, (_, j) => String(1 + j / 2));
  return {
    points: Float32Array.from(points),
    corners: Uint32Array.from(corners),
    text: {
      protocol: 4, version: '0.0.0', name: 'Made-up patient: one needle into the left half', case: 0, cases: ['Made-up patient', 'Another made-up patient'],
      regions, patches,
      template: { pitch_mm: 5, columns, rows, centre_mm: [0, 0], z_mm: -62 },
      insertions: [{ name: 'hole e3.5', hole: 'e3.5', entry_mm: [15, 5, SKIN_Z], direction: [0, 0, 1], depth_mm: 66, speed_mm_per_s: 20 }],
      stabilising: [],
      needle: { length_mm: 200, diameter_mm: 1.27, bevel_deg: 0, model: 'beam' },
      limits: { depth_mm: 110, behind_mm: 30, speed_mm_per_s: 200, tilt_deg: 10 },
      mesh: { nodes: points.length / 3, tets: 0 }, dt_ms: 1, warnings: [],
      notice: 'Not a medical device. A simulation for research and teaching.',
    },
  };
}

/** Rings of latitude and two poles; triangles counter-clockwise from outside. */
function addEllipsoid(points: number[], corners: number[], { centre, half }: Ellipsoid): void {
  const [rings, sides] = [18, 28];
  const first = points.length / 3;
  const add = (polar: number, azimuth: number) => points.push(
    centre[0] + half[0] * Math.sin(polar) * Math.cos(azimuth), centre[1] + half[1] * Math.sin(polar) * Math.sin(azimuth),
    centre[2] + half[2] * Math.cos(polar));
  add(0, 0);
  for (let i = 1; i < rings; i++) for (let k = 0; k < sides; k++) add((Math.PI * i) / rings, (2 * Math.PI * k) / sides);
  add(Math.PI, 0);
  const at = (i: number, k: number) => first + 1 + (i - 1) * sides + (k % sides);
  const last = points.length / 3 - 1;
  for (let k = 0; k < sides; k++) {
    corners.push(first, at(1, k), at(1, k + 1));
    for (let i = 1; i < rings - 1; i++) corners.push(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k), at(i + 1, k + 1), at(i, k + 1));
    corners.push(at(rings - 1, k), last, at(rings - 1, k + 1));
  }
}

/** Six faces, each a grid; nodes at the edges belong to each face that has them. */
function addBox(points: number[], corners: number[]): void {
  const n = 8;
  const numbers = new Map<string, number>();
  const node = (p: number[]) => {
    const key = p.map((v) => v.toFixed(3)).join();
    if (!numbers.has(key)) {
      numbers.set(key, points.length / 3);
      points.push(...p);
    }
    return numbers.get(key) as number;
  };
  for (let axis = 0; axis < 3; axis++) {
    const [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
    for (const side of [0, 1]) {
      const place = (i: number, j: number) => {
        const p = [0, 0, 0];
        p[axis] = side ? BOX.high[axis] : BOX.low[axis];
        p[a] = BOX.low[a] + ((BOX.high[a] - BOX.low[a]) * i) / n;
        p[b] = BOX.low[b] + ((BOX.high[b] - BOX.low[b]) * j) / n;
        return node(p);
      };
      for (let i = 0; i < n; i++) {
        for (let j = 0; j < n; j++) {
          const [p, q, r, s] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
          corners.push(...(side ? [p, q, r, p, r, s] : [p, r, q, p, s, r]));
        }
      }
    }
  }
}
