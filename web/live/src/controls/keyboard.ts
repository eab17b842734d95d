// SPDX-License-Identifier: GPL-3.0-or-later
// Keys. A focused control gets the keys that it uses; all other keys move the needle.
import { SPEEDS, type HandControl } from '../hand';
import type { ImagePanel } from '../imaging/image_panel';
import type { ImplantActions } from '../implant/panel';
import type { Session } from '../session';

export const KEYS: [string, string][] = [
  ['↑ or W, ↓ or S', 'push, pull while the key is held'],
  ['Page up, page down', 'push by 5 mm, pull by 5 mm'],
  ['Wheel', 'push or pull by 1 mm, with Shift by 0.1 mm; with Ctrl zoom the 3D view'],
  ['1, 2, 3', `set the speed to ${SPEEDS.join(', ')} mm/s`],
  ['Q, E', 'turn the bevel'],
  ['A, D or Shift ← →', 'tilt the hub to the patient’s right, left (with a plan of seeds, D drops a seed)'],
  ['Shift ↑ ↓', 'tilt the hub to anterior, posterior'],
  ['Home', 'make the hub straight again'],
  ['D; U or Ctrl Z', 'with a plan of seeds: drop the next seed, or hold the train and draw back; take it back'],
  ['G; N', 'with a plan of seeds: go to the depth of the next seed or of the train; take the next needle'],
  ['T, S; [ and ]; F', 'with the ultrasound picture: transverse, sagittal; stepper to inferior, superior; freeze (S does not pull then)'],
  ['Space', 'pause, resume'],
  ['.', 'make a single step while paused'],
  ['R', 'go back to the start of this insertion'],
  ['?', 'show or hide this list'],
];
const ROLL_DEG_PER_S = 90;
const TILT_DEG_PER_S = 4;
const TAP_S = 1 / 60;
const LONGEST_TURN_S = 0.25;  // limit of the time between two repaints

type Held = (hand: HandControl, seconds: number) => void;
const HELD: Record<string, Held> = {
  KeyW: (hand) => hand.hold(1), ArrowUp: (hand) => hand.hold(1),
  KeyS: (hand) => hand.hold(-1), ArrowDown: (hand) => hand.hold(-1),
  KeyQ: (hand, s) => hand.roll(-ROLL_DEG_PER_S * s), KeyE: (hand, s) => hand.roll(ROLL_DEG_PER_S * s),
  KeyA: (hand, s) => hand.tilt(-TILT_DEG_PER_S * s, 0), KeyD: (hand, s) => hand.tilt(TILT_DEG_PER_S * s, 0),
  'Shift+ArrowLeft': (hand, s) => hand.tilt(-TILT_DEG_PER_S * s, 0), 'Shift+ArrowRight': (hand, s) => hand.tilt(TILT_DEG_PER_S * s, 0),
  'Shift+ArrowUp': (hand, s) => hand.tilt(0, TILT_DEG_PER_S * s), 'Shift+ArrowDown': (hand, s) => hand.tilt(0, -TILT_DEG_PER_S * s),
};
const PUSHES = new Set(['KeyW', 'KeyS', 'ArrowUp', 'ArrowDown']);

export function bindKeys(session: Session, hand: HandControl, implant: ImplantActions, images: ImagePanel, toggleHelp: () => void): void {
  const held = new Map<string, Held>();  // actions of the held keys, by the key's code
  let last = 0;
  const turn = (now: number) => {
    if (held.size === 0) return;
    const seconds = Math.min(LONGEST_TURN_S, Math.max(0, (now - last) / 1000));
    last = now;
    for (const action of held.values()) action(hand, seconds);
    requestAnimationFrame(turn);
  };
  const release = (code: string) => {
    if (held.delete(code) && PUSHES.has(code)) hand.stop();
  };
  const once: Record<string, () => void> = {
    PageUp: () => hand.push(5), PageDown: () => hand.push(-5), Home: () => hand.straighten(),
    Digit1: () => hand.setSpeed(SPEEDS[0]), Digit2: () => hand.setSpeed(SPEEDS[1]), Digit3: () => hand.setSpeed(SPEEDS[2]),
    Space: () => togglePause(session), Period: () => session.command({ do: 'step', count: 1 }), KeyR: () => reset(session, hand),
  };

  const ofImplant: Record<string, () => void> = {
    KeyD: () => implant.drop(), KeyU: () => implant.undo(), KeyG: () => implant.go(), KeyN: () => implant.next(),
  };

  const ofUltrasound: Record<string, () => void> = {
    KeyT: () => images.show('transverse'), KeyS: () => images.show('sagittal'), KeyF: () => images.toggleFreeze(),
    BracketLeft: () => images.step(-1), BracketRight: () => images.step(1),
  };

  document.addEventListener('keydown', (e) => {
    const isUndo = (e.ctrlKey || e.metaKey) && !e.shiftKey && !e.altKey && e.code === 'KeyZ';
    if (isUndo && implant.isThere && !document.querySelector('dialog[open]')) {
      e.preventDefault();
      return implant.undo();
    }
    if (e.ctrlKey || e.altKey || e.metaKey || e.defaultPrevented) return;
    if (e.key === '?') return toggleHelp();
    if (usesKey(e.target as HTMLElement, e.code) || document.querySelector('dialog[open]')) return;
    if (images.isUltrasound && e.code in ofUltrasound && !e.shiftKey) {
      e.preventDefault();
      if (!e.repeat || e.code.startsWith('Bracket')) ofUltrasound[e.code]();
      return;
    }
    if (implant.isThere && e.code in ofImplant && !e.shiftKey) {
      e.preventDefault();
      if (!e.repeat) ofImplant[e.code]();
      return;
    }
    const action = HELD[`${e.shiftKey ? 'Shift+' : ''}${e.code}`] ?? (e.shiftKey && e.code.startsWith('Key') ? HELD[e.code] : undefined);
    if (action) {
      e.preventDefault();
      if (held.has(e.code)) return;
      held.set(e.code, action);
      action(hand, TAP_S);  // a tapped key may be released before the next repaint
      if (held.size > 1) return;
      last = performance.now();
      requestAnimationFrame(turn);
    } else if (once[e.code] && !e.shiftKey) {
      e.preventDefault();
      if (!e.repeat || e.code.startsWith('Page') || e.code === 'Period') once[e.code]();
    }
  });
  document.addEventListener('keyup', (e) => release(e.code));
  // After a click with a mouse, keys move the needle again. A control that was reached with the Tab key keeps the
  // focus.
  document.addEventListener('click', (e) => {
    const control = (e.target as HTMLElement).closest<HTMLElement>('button, summary, input, .hole');
    if (e.detail > 0 && control && !control.closest('dialog')) control.blur();
  });
  window.addEventListener('blur', () => [...held.keys()].forEach(release));
}

export function togglePause(session: Session): void {
  const { status } = session;
  if (status?.mode === 'replay') session.command({ do: 'play', rate: status.replay?.playing ? 0 : status.replay?.rate || 1 });
  else session.command({ do: status?.paused ? 'resume' : 'pause' });
}

export function reset(session: Session, hand: HandControl): void {
  hand.rest();
  session.command({ do: 'reset' });
}

/** Whether the focused control uses a key itself. */
function usesKey(target: HTMLElement, code: string): boolean {
  if (target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement) return true;
  if (target instanceof HTMLInputElement) return target.type === 'checkbox' ? code === 'Space' : /^(Arrow|Page|Home|End|Space)/.test(code);
  const button = target instanceof HTMLButtonElement || target.tagName === 'SUMMARY' || target instanceof HTMLAnchorElement;
  return button && (code === 'Space' || code === 'Enter');
}
