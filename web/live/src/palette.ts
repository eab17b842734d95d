// SPDX-License-Identifier: GPL-3.0-or-later
export { INK, PALE, SOFT } from '../../shared/plot_style';
export const RESTING = '#6d7682';  // needles that stay in the tissue
export const ACCENT = '#0072b2';
export const HARM = '#b3261e';
export const WARN = '#b34700';
export const SEED = '#d55e00';
