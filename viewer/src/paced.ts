/** Draw when asked to, once a frame and not sooner than so many milliseconds after the last time. */
export function paced(draw: () => void, least = 0): () => void {
  let scheduled = false;
  let last = Number.NEGATIVE_INFINITY;
  const frame = (now: number) => {
    if (now - last < least) {
      requestAnimationFrame(frame);
      return;
    }
    scheduled = false;
    last = now;
    draw();
  };
  return () => {
    if (scheduled) return;
    scheduled = true;
    requestAnimationFrame(frame);
  };
}

/** Milliseconds before what failed so often is tried again. */
export function pauseAfter(failures: number): number {
  return 1000 * Math.min(2 ** failures, 60);
}
