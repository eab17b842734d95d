// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { isolines, shapePath, slice } from 'report/src/dose/isolines';
import { inPicture, PLANES } from 'report/src/dose/planes';

const [transverse, sagittal, coronal] = PLANES;

/** A grid whose values are those of a function of the place. */
function gridOf(size, origin, spacing, f) {
  const values = new Float64Array(size[0] * size[1] * size[2]);
  for (let k = 0, p = 0; k < size[2]; k++) {
    for (let j = 0; j < size[1]; j++) {
      for (let i = 0; i < size[0]; i++) values[p++] = f(origin[0] + spacing * i, origin[1] + spacing * j, origin[2] + spacing * k);
    }
  }
  return { size, origin, spacing, scale: 1, values };
}

test('the patient lies in the pictures as clinics display them', () => {
  const right = (plane, x) => inPicture(plane, x)[0];
  const down = (plane, x) => inPicture(plane, x)[1];
  const [left, posterior, superior] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  assert.equal(right(transverse, left), 1, 'seen from the feet, the left is at the right');
  assert.equal(down(transverse, posterior), 1, 'the back is below');
  assert.equal(right(sagittal, posterior), 1, 'seen from the left, the back is at the right');
  assert.equal(down(sagittal, superior), -1, 'the head is above');
  assert.equal(right(coronal, left), 1);
  assert.equal(down(coronal, superior), -1);
  for (const plane of PLANES) {
    assert.equal(plane.ends.right, { 0: 'L', 1: 'P' }[plane.across]);
    assert.equal(plane.ends.bottom, plane.up ? 'I' : 'P');
  }
});

test('the line of a ball is a circle with its radius about its centre, in every plane', () => {
  const centre = [3, -20, 7];
  const ball = gridOf([41, 37, 45], [-17, -38, -15], 1, (x, y, z) => 20 - Math.hypot(x - centre[0], y - centre[1], z - centre[2]));
  for (const plane of PLANES) {
    const off = 4.5;
    const cut = slice(ball, plane, centre[plane.normal] + off);
    const lines = isolines(cut, 8);  // radius 12
    assert.equal(lines.length, 1);
    const [cx, cy] = inPicture(plane, centre);
    for (const [x, y] of lines[0]) assert.ok(Math.abs(Math.hypot(x - cx, y - cy) - Math.sqrt(144 - off * off)) < 0.1, `${plane.name} ${x} ${y}`);
  }
});

test('lines end at the edge of the grid, shapes are closed along it', () => {
  const ramp = gridOf([20, 10, 10], [0, 0, 0], 2, (x) => x);
  const cut = slice(ramp, transverse, 5);
  const lines = isolines(cut, 13);
  assert.equal(lines.length, 1);
  for (const [x] of lines[0]) assert.ok(Math.abs(x - 13) < 1e-6, `${x}`);
  assert.match(shapePath(cut, 13), /^M[^M]*Z$/);
});

test('there is no section outside the grid', () => {
  const grid = gridOf([5, 5, 5], [0, 0, 0], 1, () => 1);
  assert.equal(slice(grid, transverse, 9), null);
  assert.notEqual(slice(grid, transverse, 2.2), null);
});
