// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a gamepad while one is connected: left stick or triggers push and pull, right stick tilts, shoulders turn the
// bevel.
import type { HandControl } from '../hand';

const REST = 0.15;  // smaller values count as 0, because sticks do not return to exactly 0
const TILT_DEG_PER_S = 4;
const ROLL_DEG_PER_S = 90;

export function bindGamepad(hand: HandControl): void {
  let running = false;
  let pushing = false;
  let last = 0;
  const axis = (pad: Gamepad, i: number) => {
    const value = pad.axes[i] ?? 0;
    return Math.abs(value) < REST ? 0 : value;
  };
  const turn = (now: number) => {
    const pad = navigator.getGamepads().find((p) => p?.connected);
    if (!pad) {  // disconnected
      if (pushing) hand.stop();
      running = pushing = false;
      return;
    }
    const seconds = Math.min(0.25, (now - last) / 1000);
    last = now;
    const pressed = (i: number) => pad.buttons[i]?.value ?? 0;
    const push = -axis(pad, 1) + pressed(7) - pressed(6);
    if (Math.abs(push) > REST) {
      hand.hold(Math.max(-1, Math.min(1, push)));
      pushing = true;
    } else if (pushing) {
      hand.stop();
      pushing = false;
    }
    const [left, back] = [axis(pad, 2), axis(pad, 3)];
    if (left !== 0 || back !== 0) hand.tilt(left * TILT_DEG_PER_S * seconds, -back * TILT_DEG_PER_S * seconds);
    const roll = pressed(5) - pressed(4);
    if (roll !== 0) hand.roll(roll * ROLL_DEG_PER_S * seconds);
    requestAnimationFrame(turn);
  };
  window.addEventListener('gamepadconnected', () => {
    if (running) return;
    running = true;
    last = performance.now();
    requestAnimationFrame(turn);
  });
}
