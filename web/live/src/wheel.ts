// SPDX-License-Identifier: GPL-3.0-or-later
// Converts wheel events to notches. A busy browser joins several notches in one event; a touchpad sends many events of
// a fraction of a notch.

const NOTCH_PX = 100;  // browsers report 100 to 120
const NOTCH_LINES = 3;

export interface WheelTurn { deltaX: number; deltaY: number; deltaMode: number; shiftKey: boolean }

/** The number of notches, positive away from the hand; a tenth of it with Shift. */
export function wheelNotches(e: WheelTurn): number {
  const turned = 0 - (e.deltaY || e.deltaX);  // with Shift some browsers report a horizontal turn
  const notches = turned / (e.deltaMode === 0 ? NOTCH_PX : e.deltaMode === 1 ? NOTCH_LINES : 1);
  const counted = Math.abs(notches) < 0.5 ? notches : Math.round(notches);
  return counted * (e.shiftKey ? 0.1 : 1);
}
