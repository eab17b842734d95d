// SPDX-License-Identifier: GPL-3.0-or-later
// Work that is done once before the next repaint, even if it is requested several times.

/** Returns a function that requests `work` for the next repaint. */
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

/** The same, but at most once per `interval` ms: for text and curves, which need not change sixty times per second. */
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
