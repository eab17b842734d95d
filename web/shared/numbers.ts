// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as pages show them: with the minus sign (U+2212), which is as wide as the plus sign, and never "−0".

const PLAIN = new Intl.NumberFormat('en', { maximumFractionDigits: 12, maximumSignificantDigits: 12 });

/** The text of a number, with a minus sign instead of a hyphen; a dash where it is not known. */
export function numberText(value: number | null | undefined, digits?: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const text = digits === undefined ? PLAIN.format(value) : value.toFixed(digits);
  return Number(text.replaceAll(',', '')) === 0 ? text.replace('-', '') : text.replace('-', '−');
}
