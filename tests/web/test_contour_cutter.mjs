// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { makePatient } from './made_up_patient';
import { regionTriangles } from 'live/src/scene';
import { ContourCutter } from 'live/src/sections/contour_cutter';

const patient = makePatient();
const scene = { ...patient.text, points: patient.points, corners: patient.corners };

function contours(cutter) {
  return Array.from({ length: cutter.contours }, (_, c) => {
    const corners = [];
    for (let i = cutter.starts[c]; i < cutter.starts[c + 1]; i++) corners.push([cutter.corners[2 * i], cutter.corners[2 * i + 1]]);
    return corners;
  });
}

function area(corners) {
  let twice = 0;
  corners.forEach(([x, y], i) => {
    const [u, v] = corners[(i + 1) % corners.length];
    twice += x * v - u * y;
  });
  return Math.abs(twice) / 2;
}

function cutRegion(region, axis, value, points = scene.points) {
  const cutter = new ContourCutter(regionTriangles(scene, region));
  cutter.cut(points, axis, value);
  return contours(cutter);
}

test('a plane cuts an ellipsoid in one ellipse of the right size', () => {
  for (const [axis, half] of [[0, [16, 20]], [1, [23, 20]], [2, [23, 16]]]) {
    const cut = cutRegion(1, axis, 0.001);
    assert.equal(cut.length, 1);
    const ellipse = Math.PI * half[0] * half[1];
    // Inscribed polygons with 28 and 36 sides (18 rings) have 0.992 and 0.995 of the circle's area.
    assert.ok(area(cut[0]) > 0.985 * ellipse && area(cut[0]) <= ellipse, `axis ${axis}: ${area(cut[0])} of ${ellipse}`);
  }
});

test('corners of a contour lie on the surface, neighbours in one triangle', () => {
  const [cut] = cutRegion(1, 2, 7.3);
  for (const [x, y] of cut) {
    const level = (x / 23) ** 2 + (y / 16) ** 2 + (7.3 / 20) ** 2;
    assert.ok(level <= 1.00001 && level > 0.97, `${level}`);
  }
  cut.forEach(([x, y], i) => {
    const [u, v] = cut[(i + 1) % cut.length];
    assert.ok(Math.hypot(u - x, v - y) < 6, 'a jump');
  });
});

test('a plane through nodes gives closed contours too', () => {
  const [cut, ...rest] = cutRegion(1, 2, 0);  // a ring of nodes lies in the plane
  assert.equal(rest.length, 0);
  assert.ok(Math.abs(area(cut) - 0.9916 * Math.PI * 23 * 16) < 2, `${area(cut)}`);
});

test('the tissue around the organs has one contour outside and one for each hole, each corner once', () => {
  const cut = cutRegion(0, 2, 2.5);
  const areas = cut.map(area).sort((a, b) => b - a);
  assert.equal(cut.length, 4);  // box; prostate, rectum, pubic arch
  assert.ok(Math.abs(areas[0] - 110 * 100) < 1e-2, `${areas[0]}`);
  const organs = [1, 3, 4].map((region) => area(cutRegion(region, 2, 2.5)[0])).sort((a, b) => b - a);
  organs.forEach((organ, i) => assert.ok(Math.abs(organ - areas[i + 1]) < 1e-2));
});

test('a plane beside the region cuts nothing, and the next cut is not disturbed by the last', () => {
  const cutter = new ContourCutter(regionTriangles(scene, 1));
  cutter.cut(scene.points, 2, 50);
  assert.equal(cutter.contours, 0);
  cutter.cut(scene.points, 2, 3.1);
  const first = contours(cutter);
  cutter.cut(scene.points, 2, -12);
  cutter.cut(scene.points, 2, 3.1);
  assert.deepEqual(contours(cutter), first);
});

test('contours follow the deformed positions', () => {
  const moved = scene.points.map((p, i) => (i % 3 === 2 ? p + 5 : p));
  assert.deepEqual(cutRegion(1, 2, 8, moved).map((c) => area(c).toFixed(2)), cutRegion(1, 2, 3).map((c) => area(c).toFixed(2)));
});

test('an open surface gives open pieces, not an endless walk', () => {
  const cutter = new ContourCutter(Uint32Array.of(0, 1, 2, 1, 3, 2));
  cutter.cut(Float32Array.of(0, 0, -1, 1, 0, 1, 0, 1, 1, 1, 1, -1), 2, 0);
  assert.ok(cutter.contours <= 2);
});
