// Frames on demand, each with as much work as it has time for.

/** Runs frames while there is something to do. */
export class Loop {
  passMilliseconds = 10;
  private running = false;
  private touched = 0;

  constructor(private readonly frame: () => boolean) {}

  /** Passes that a frame has time for: few while something moves, more while the picture only gets better. */
  get budget(): number {
    const milliseconds = performance.now() - this.touched < 250 ? 10 : 50;
    return Math.min(64, Math.max(1, Math.round(milliseconds / this.passMilliseconds)));
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
