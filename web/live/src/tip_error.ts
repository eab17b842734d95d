// SPDX-License-Identifier: GPL-3.0-or-later
// The tip error: the place of the tip in the tissue minus its planned place. Both are places in the undeformed patient,
// where a seed dropped at the tip lies once the needle is out. They are shown with the undeformed outlines of the
// organs.
import type { Frame } from './wire';

const SAME_DEPTH_MM = 0.1;
const WORTH_A_MARK_MM = 0.5;

export interface TipErrorEnds {
  planned: Float32Array;  // [mm] LPS, tip of a rigid straight needle on the same base
  reached: Float32Array;  // [mm] LPS, undeformed place of the tissue at the tip
}

export function makeEnds(): TipErrorEnds {
  return { planned: new Float32Array(3), reached: new Float32Array(3) };
}

/** Whether the tip is in the tissue, so that there is a tip error. */
export function hasTipError({ tipError }: Frame): boolean {
  return Number.isFinite(tipError[0]);
}

/** Whether the needle has been drawn back from the deepest point, to which the tip error belongs. */
export function isDrawnBack({ depth, tipErrorDepth }: Frame): boolean {
  return depth < tipErrorDepth - SAME_DEPTH_MM;
}

/** Computes the two points to mark. False if none are to be marked: no error, a small error, or a needle drawn back. */
export function tipErrorEnds(frame: Frame, needleLength: number, { planned, reached }: TipErrorEnds): boolean {
  const { tipError, base, orientation: [w, x, y, z] } = frame;
  if (!hasTipError(frame) || isDrawnBack(frame) || Math.hypot(...tipError) < WORTH_A_MARK_MM) return false;
  const axis = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)];
  for (let k = 0; k < 3; k++) {
    planned[k] = base[k] + needleLength * axis[k];
    reached[k] = planned[k] + tipError[k];
  }
  return true;
}
