// SPDX-License-Identifier: GPL-3.0-or-later
// The case, as the server describes it. Lengths are in mm, coordinates in LPS.

export interface Region {
  name: string; label: string; color: string; opacity: number; target: boolean; background: boolean; spared?: boolean; volume_cc: number;
}
// outside is −1 at the patient's surface
export interface Patch { inside: number; outside: number; first: number; count: number }
export interface Template { pitch_mm: number; columns: string[]; rows: string[]; centre_mm: [number, number]; z_mm: number }
export interface Insertion {
  name: string; hole: string; entry_mm: [number, number, number]; direction: [number, number, number]; depth_mm: number;
  speed_mm_per_s: number;
}

export interface SceneText {
  protocol: number; version: string; name: string; case: number; cases: string[];
  regions: Region[];
  patches: Patch[];
  template: Template | null;
  insertions: Insertion[];
  stabilising: string[];  // holes in which needles stay
  needle: { length_mm: number; diameter_mm: number; bevel_deg: number; model: string };
  limits: { depth_mm: number; behind_mm: number; speed_mm_per_s: number; tilt_deg: number };
  mesh: { nodes: number; tets: number };
  dt_ms: number;
  warnings: string[];
  notice: string;
}

export interface Scene extends SceneText {
  points: Float32Array;  // (3 × nodes) undeformed positions
  corners: Uint32Array;  // (3 × triangles)
}

/** Corners of a region's whole surface, made of all its patches; counter-clockwise seen from outside. */
export function regionTriangles(scene: Scene, region: number): Uint32Array {
  const patches = scene.patches.filter((p) => p.inside === region || p.outside === region);
  const triangles = new Uint32Array(3 * patches.reduce((sum, p) => sum + p.count, 0));
  let at = 0;
  for (const patch of patches) {
    const flip = patch.outside === region;
    for (let t = patch.first; t < patch.first + patch.count; t++) {
      triangles[at++] = scene.corners[3 * t];
      triangles[at++] = scene.corners[3 * t + (flip ? 2 : 1)];
      triangles[at++] = scene.corners[3 * t + (flip ? 1 : 2)];
    }
  }
  return triangles;
}

/** Corners of the outer surface of the gland, that is of all target regions together. Orientation as in the patches. */
export function glandTriangles(scene: Scene): Uint32Array {
  const target = (region: number) => scene.regions[region]?.target ?? false;
  const corners: number[] = [];
  for (const patch of scene.patches) {
    if (target(patch.inside) === target(patch.outside)) continue;
    for (let i = 3 * patch.first; i < 3 * (patch.first + patch.count); i++) corners.push(scene.corners[i]);
  }
  return Uint32Array.from(corners);
}

export interface Hole { name: string; x: number; y: number; column: number; row: number }

/** All holes of a template: columns from the patient's right to the left, rows from posterior to anterior. */
export function holes(template: Template): Hole[] {
  const { pitch_mm: pitch, columns, rows, centre_mm: centre } = template;
  return rows.flatMap((row, j) => columns.map((column, i) => ({
    name: column + row,
    x: centre[0] + (i - (columns.length - 1) / 2) * pitch,
    y: centre[1] - (j - (rows.length - 1) / 2) * pitch,
    column: i,
    row: j,
  })));
}

type Bounds = [number, number][];

function include(bounds: Bounds, p: ArrayLike<number>, from: number, margin: number): void {
  bounds.forEach((b, k) => {
    b[0] = Math.min(b[0], p[from + k] - margin);
    b[1] = Math.max(b[1], p[from + k] + margin);
  });
}

function nothing(): Bounds {
  return [[Infinity, -Infinity], [Infinity, -Infinity], [Infinity, -Infinity]];
}

const AROUND_TARGET_MM = 12;

/**
 * [low, high] of x, y, z that a section must show: the target with some tissue around it, the holes and the entries.
 */
export function focusBounds(scene: Scene, list: Hole[]): Bounds {
  if (!scene.regions.some((r) => r.target)) return organBounds(scene);
  const bounds = nothing();
  scene.regions.forEach((region, i) => {
    if (!region.target) return;
    for (const node of regionTriangles(scene, i)) include(bounds, scene.points, 3 * node, AROUND_TARGET_MM);
  });
  const z = (bounds[2][0] + bounds[2][1]) / 2;
  for (const hole of list) include(bounds, [hole.x, hole.y, z], 0, 5);
  for (const insertion of scene.insertions) include(bounds, insertion.entry_mm, 0, 3);
  return bounds;
}

/**
 * [low, high] of x, y, z of the regions that are not background and of the tips at their furthest in front of the skin.
 */
export function organBounds(scene: Scene): Bounds {
  const bounds = nothing();
  const all = scene.regions.every((r) => r.background);
  scene.regions.forEach((region, i) => {
    if (region.background && !all) return;
    for (const node of regionTriangles(scene, i)) include(bounds, scene.points, 3 * node, 0);
  });
  for (const insertion of scene.insertions) {
    include(bounds, insertion.entry_mm, 0, 0);
    include(bounds, insertion.entry_mm.map((x, k) => x - scene.limits.behind_mm * insertion.direction[k]), 0, 2);
  }
  return bounds;
}

/**
 * Whether two scenes show the same patient. With another hole, the scene comes again with surfaces refined along it.
 */
export function samePatient(a: Scene, b: Scene): boolean {
  return a.case === b.case && a.name === b.name && a.mesh.nodes === b.mesh.nodes && a.mesh.tets === b.mesh.tets
    && a.regions.length === b.regions.length && a.regions.every((r, i) => r.name === b.regions[i].name);
}
