// SPDX-License-Identifier: GPL-3.0-or-later
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { numberText } from 'shared/numbers';

test('negative numbers have the minus sign, and zero has none', () => {
  assert.equal(numberText(-5), '−5');
  assert.equal(numberText(-0.25), '−0.25');
  assert.equal(numberText(-1234.5), '−1,234.5');
  assert.equal(numberText(-0), '0');
  assert.equal(numberText(-0.004, 2), '0.00');
  assert.equal(numberText(-0.006, 2), '−0.01');
  assert.equal(numberText(40), '40');
  assert.equal(numberText(0.1 + 0.2), '0.3');
  assert.equal(numberText(2000), '2,000');
});

test('what is not known is a dash', () => {
  for (const unknown of [null, undefined, NaN, Infinity]) assert.equal(numberText(unknown), '–');
});
