// SPDX-License-Identifier: GPL-3.0-or-later
// How far a wheel was turned. A browser that is busy makes one event of several notches, a touchpad many of a fraction of one.

const NOTCH_PX = 100;  // browsers say 100 to 120
const NOTCH_LINES = 3;

export interface WheelTurn { deltaX: number; deltaY: number; deltaMode: number; shiftKey: boolean }

/** Notches, positive away from the hand; with Shift tenths of them. */
export function wheelNotches(e: WheelTurn): number {
  const turned = 0 - (e.deltaY || e.deltaX);  // with Shift some browsers turn the wheel sideways
  const notches = turned / (e.deltaMode === 0 ? NOTCH_PX : e.deltaMode === 1 ? NOTCH_LINES : 1);
  const counted = Math.abs(notches) < 0.5 ? notches : Math.round(notches);
  return counted * (e.shiftKey ? 0.1 : 1);
}
