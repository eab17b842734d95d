// SPDX-License-Identifier: GPL-3.0-or-later
import type uPlot from 'uplot';
import { numberText } from './numbers';

// Colours by Okabe & Ito, distinguishable with every kind of colour vision.
export const INK = '#23262b';
export const PALE = '#8a9099';
export const SOFT = '#5b6169';
export const GRID = '#e6e8eb';
export const CURVES = [
  { key: 'axial', label: 'Axial', color: '#0072b2', width: 2 },
  { key: 'sagittal', label: 'Sagittal', color: '#d55e00', width: 1.5 },
  { key: 'lateral', label: 'Lateral', color: '#009e73', width: 1.5 },
] as const;
export type CurveKey = (typeof CURVES)[number]['key'];

/** Text size of the page [CSS px]. */
export function rem(): number {
  return parseFloat(getComputedStyle(document.documentElement).fontSize);
}

/** Text size of plots [CSS px], which grow with the screen. */
export function fontSize(): number {
  return rem() * 0.82;
}

/** Scale of lines and dots, in proportion to the text size: 1 on a usual screen. */
export function lineScale(): number {
  return Math.max(1, fontSize() / 13);
}

export function font(): string {
  return `${fontSize().toFixed(1)}px ${getComputedStyle(document.body).fontFamily}`;
}

/** The same for a canvas, whose unit is a pixel of the device. */
export function canvasFont(): string {
  return `${fontSize() * devicePixelRatio}px ${getComputedStyle(document.body).fontFamily}`;
}

export function axis(label: string, size: number): uPlot.Axis {
  return {
    label: label || undefined,
    labelFont: font(),
    font: font(),
    labelSize: fontSize() * 1.7,
    size,
    values: (_u, marks) => marks.map((mark) => (mark === null ? '' : numberText(mark))),
    stroke: INK,
    grid: { stroke: GRID, width: 1 },
    ticks: { stroke: GRID, width: 1, size: 5 },
  };
}

/** A number with its unit and a readable number of digits. */
export function newtons(value: number): string {
  return `${numberText(value, Math.abs(value) < 0.1 ? 3 : 2)} N`;
}
