// SPDX-License-Identifier: GPL-3.0-or-later
// Colours by Okabe & Ito, as in the plots of the report.
export const BLUE = '#0072b2';
export const SKY = '#56b4e9';
export const VERMILION = '#d55e00';
const GREEN = '#009e73';

/** Colour of a variant of the insertions. */
export function colorOf(id: string): string {
  if (id.startsWith('bcs')) return VERMILION;
  if (id.startsWith('woodbury')) return BLUE;
  return GREEN;
}
