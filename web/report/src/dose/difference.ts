// SPDX-License-Identifier: GPL-3.0-or-later
// The map of computed dose minus the dose of a file: blue where less is computed, red where more is.
import { element } from '../../../shared/dom';
import { numberText } from '../../../shared/numbers';
import type { Difference, DoseData } from './data';
import type { Plane } from './planes';

const LESS = [0, 90, 181];
const MORE = [200, 16, 46];

/** The colour of a share −1 … 1 of the limit. */
function colour(share: number): [number, number, number] {
  const end = share < 0 ? LESS : MORE;
  const strength = Math.min(1, Math.abs(share));
  return [0, 1, 2].map((k) => Math.round(255 + strength * (end[k] - 255))) as [number, number, number];
}

/** A picture of the plane nearest to a height, with the place of its corner and its size [mm in the picture]; null outside. */
export function differenceImage({ grid }: Difference, plane: Plane, height: number): { url: string; x: number; y: number; width: number; height: number } | null {
  const { size, origin, spacing, values } = grid;
  const at = Math.round((height - origin[plane.normal]) / spacing);
  if (!(at >= 0 && at < size[plane.normal])) return null;
  const width = size[plane.across];
  const rows = size[plane.down];
  const strides = [1, size[0], size[0] * size[1]];
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = rows;
  const context = canvas.getContext('2d');
  if (!context) return null;
  const image = context.createImageData(width, rows);
  for (let j = 0; j < rows; j++) {
    for (let i = 0; i < width; i++) {
      const value = values[i * strides[plane.across] + j * strides[plane.down] + at * strides[plane.normal]];
      if (value === 0) continue;
      const row = plane.up ? rows - 1 - j : j;
      image.data.set([...colour((value - 128) / 127), 255], 4 * (row * width + i));
    }
  }
  context.putImageData(image, 0, 0);
  const top = plane.up ? -(origin[plane.down] + (rows - 1) * spacing) : origin[plane.down];
  return { url: canvas.toDataURL(), x: origin[plane.across] - spacing / 2, y: top - spacing / 2, width: width * spacing, height: rows * spacing };
}

/** The scale of colours. */
export function buildDifferenceKey({ difference }: DoseData, box: HTMLElement): void {
  if (!difference) return;
  for (const share of [-1, -0.5, 0, 0.5, 1]) {
    const part = element('span');
    const swatch = element('i', 'swatch');
    swatch.style.background = `rgb(${colour(share).join(' ')})`;
    const end = share === -1 ? ' or less' : share === 1 ? ' or more' : '';
    part.append(swatch, `${share > 0 ? '+' : ''}${numberText(Number((share * difference.limit_Gy).toPrecision(3)))} Gy${end}`);
    box.append(part);
  }
  box.append(element('span', '', 'no colour: not compared'));
}
