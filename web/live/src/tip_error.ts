// SPDX-License-Identifier: GPL-3.0-or-later
// Where the tip is in the tissue, less where it was to be, and the two points. Both are places in the undeformed patient,
// where a seed dropped at the tip lies once the needle is out: to be seen beside the organs as they were.
import type { Frame } from './wire';

const SAME_DEPTH_MM = 0.1;
const WORTH_A_MARK_MM = 0.5;

export interface TipErrorEnds {
  planned: Float32Array;  // [mm] LPS, where the tip of a rigid straight needle on the same base is
  reached: Float32Array;  // the tissue that the tip is in
}

export function makeEnds(): TipErrorEnds {
  return { planned: new Float32Array(3), reached: new Float32Array(3) };
}

/** Whether the tip is in the tissue, so that there is an error of it. */
export function hasTipError({ tipError }: Frame): boolean {
  return Number.isFinite(tipError[0]);
}

/** Whether the needle has been drawn back from the deepest point, which its error is of. */
export function isDrawnBack({ depth, tipErrorDepth }: Frame): boolean {
  return depth < tipErrorDepth - SAME_DEPTH_MM;
}

/** Writes the ends of what is to be marked. False where that is nothing: no error, a small one, or a needle on its way out. */
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
