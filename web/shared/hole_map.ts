// SPDX-License-Identifier: GPL-3.0-or-later
// The map of the template's holes (docs/results) and its colours.
import { viridis } from './colors';
import { INK } from './plot_style';

export interface Shift { LR: number; AP: number; SI: number; norm: number }  // [mm]

export interface MappedHole {
  hole: string;
  depth_mm: number;
  in_target_mm: number;
  clearance_mm: Record<'bone' | 'urethra' | 'rectum', number | null>;
  shift_at_break_mm: Shift | null;
  shift_max_mm: Shift | null;
  tip_error_mm: Shift | null;
  predicted: boolean;
  remark: string;
  /** With needles in place: what counts from the tissue as they hold it. */
  in_place?: { shift_at_break_mm: Shift | null; shift_max_mm: Shift | null; tip_error_mm: Shift | null };
}

export interface HoleMap {
  columns: string[];
  rows: string[];
  pitch_mm: number;
  planned: string;
  missing: number;
  holes: MappedHole[];
}

/** A quantity that a map has for each hole. */
export interface Measure {
  key: string;
  label: string;
  of(hole: MappedHole): number | null;  // [mm]
  clearance: boolean;                   // true: small values are bad; false: large values are bad
}

export const MEASURES: Measure[] = [
  { key: 'bone', label: 'Clearance to bone', of: (h) => h.clearance_mm.bone, clearance: true },
  { key: 'urethra', label: 'Clearance to the urethra', of: (h) => h.clearance_mm.urethra, clearance: true },
  { key: 'rectum', label: 'Clearance to the rectum', of: (h) => h.clearance_mm.rectum, clearance: true },
  { key: 'break', label: 'Gland shift when its capsule breaks', of: (h) => (h.in_place ?? h).shift_at_break_mm?.norm ?? null, clearance: false },
  { key: 'shift', label: 'Largest gland shift', of: (h) => (h.in_place ?? h).shift_max_mm?.norm ?? null, clearance: false },
  { key: 'tip', label: 'Tip off its target', of: (h) => (h.in_place ?? h).tip_error_mm?.norm ?? null, clearance: false },
];

/** The clearance to the nearest structure. */
export const NEAREST: Measure = {
  key: 'nearest', label: 'Smallest clearance', clearance: true,
  of: (h) => Object.values(h.clearance_mm).reduce((least, mm) => (mm === null ? least : least === null ? mm : Math.min(least, mm)), null),
};

/** Larger clearances [mm] have the same colour. */
export const FAR_MM = 20;

/** Value [mm] at which the scale of a measure ends. */
export function scaleEnd(measure: Measure, map: HoleMap): number {
  if (measure.clearance) return FAR_MM;
  const most = Math.max(0, ...map.holes.map((h) => measure.of(h) ?? 0));
  const step = most > 10 ? 5 : most > 2 ? 1 : 0.5;
  return Math.max(step, Math.ceil(most / step - 1e-9) * step);
}

function share(measure: Measure, end: number, mm: number): number {
  const s = Math.max(0, Math.min(1, mm / end));
  return measure.clearance ? s : 1 - s;  // dark colours stand for bad values
}

function rgb(color: ArrayLike<number>): string {
  return `rgb(${[0, 1, 2].map((k) => Math.round(255 * color[k])).join(',')})`;
}

/** Colours of a hole and of the text on it, for a value [mm]. Their brightness can be seen with every colour vision. */
export function colorsOf(measure: Measure, end: number, mm: number): { fill: string; text: string } {
  const color = new Float32Array(3);
  const s = share(measure, end, mm);
  viridis(s, color, 0);
  return { fill: rgb(color), text: s < 0.55 ? '#fff' : INK };
}

/** The colours of a scale from 0 to its end, as a CSS gradient. */
export function scaleGradient(measure: Measure): string {
  const stops = Array.from({ length: 21 }, (_, i) => colorsOf(measure, 20, i).fill);
  return `linear-gradient(to right, ${stops.join(',')})`;
}

/** Labels of the two ends of a scale. */
export function scaleWords(measure: Measure, end: number): [string, string] {
  return measure.clearance ? ['0 mm: passes through', `${end} mm or more`] : ['0 mm', `${end} mm`];
}

/** Whether a map has values of a measure. A model may lack a structure, and predictions may be missing. */
export function isKnown(measure: Measure, map: HoleMap): boolean {
  return map.holes.some((h) => measure.of(h) !== null);
}

/** A value with few digits, to be written in a hole. */
export function shortText(mm: number): string {
  return mm === 0 || mm >= 9.95 ? mm.toFixed(0) : mm.toFixed(1);
}

/** All values of a hole as text, one line each. */
export function tellOf(hole: MappedHole): string {
  const lines = [`Hole ${hole.hole}`];
  if (hole.depth_mm > 0) lines.push(`${hole.depth_mm.toFixed(1)} mm deep, ${hole.in_target_mm.toFixed(1)} mm of it in the gland`);
  for (const measure of MEASURES) {
    const mm = measure.of(hole);
    if (mm !== null) lines.push(`${measure.label}: ${measure.clearance && mm === 0 ? 'passes through' : `${mm.toFixed(measure.clearance ? 1 : 2)} mm`}`);
  }
  if (hole.remark) lines.push(hole.remark);
  return lines.join('\n');
}
