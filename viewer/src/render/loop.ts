// Frames on demand, each with as much work as it has time for.

/** Draw when asked to, once a frame and not sooner than so many milliseconds after the last time. */
export function paced(draw: () => void, least: number): () => void {
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

/** Milliseconds after a move in which the next one is expected. */
const MOVING = 250;
/** Share of the time while something moves that goes into a better picture. */
const SPARE = 0.15;

/** Runs frames while there is something to do. */
export class Loop {
  passMilliseconds = 10;
  private running = false;
  private touched = 0;
  private spared = 0;
  private last = 0;

  constructor(private readonly frame: () => boolean) {}

  /** Passes that a frame has time for: one now and then while something moves, more while the picture only gets better. */
  budget(): number {
    const now = performance.now();
    this.spared = Math.min(this.spared + SPARE * (now - this.last), 2 * this.passMilliseconds);
    this.last = now;
    if (now - this.touched >= MOVING)
      return Math.min(64, Math.max(1, Math.round(50 / this.passMilliseconds)));
    const passes = Math.floor(this.spared / this.passMilliseconds);
    this.spared -= passes * this.passMilliseconds;
    return passes;
  }

  /** Something moved. */
  run(): void {
    this.touched = performance.now();
    this.goOn();
  }

  goOn(): void {
    if (this.running) return;
    this.running = true;
    requestAnimationFrame(this.step);
  }

  private readonly step = () => {
    this.running = false;
    if (this.frame()) this.goOn();
  };
}
