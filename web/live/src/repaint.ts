// SPDX-License-Identifier: GPL-3.0-or-later
// Work that is done once before the next repaint, however often it is asked for until then.

/** Returns what asks for `work`. */
export function onRepaint(work: () => void): () => void {
  let pending = false;
  const run = () => {
    pending = false;
    work();
  };
  return () => {
    if (pending) return;
    pending = true;
    requestAnimationFrame(run);
  };
}

/** The same, at most once in `interval` ms: for text and curves, which nobody reads sixty times a second. */
export function onRepaintEvery(interval: number, work: () => void): () => void {
  let last = -Infinity;
  let timer = 0;
  const request = onRepaint(() => {
    last = performance.now();
    work();
  });
  return () => {
    const wait = last + interval - performance.now();
    if (wait <= 0) return request();
    if (timer) return;
    timer = window.setTimeout(() => {
      timer = 0;
      request();
    }, wait);
  };
}
