// A question that is asked as long as something moves, and answered roughly and soon; and in full when nothing moves any more.
//
// One at a time. What is wanted when an answer has come is asked for next, so nothing is ever queued; the full answer is
// asked for when nothing has moved for a while, and taken back when something does, or when a change of the question itself is
// awaited: it would keep the answer busy that the change waits for.

/** Milliseconds without a change after which the full answer is asked for. */
const STILL = 250;

export interface Asking<Q, A> {
  readonly ask: (question: Q, draft: boolean, signal: AbortSignal) => Promise<A>;
  /** An answer has come, to what is wanted now or was a moment ago. */
  readonly onAnswer: (answer: A, draft: boolean) => void;
  /** Whether what came last is not the full answer to what is wanted. */
  readonly onBehind: (behind: boolean) => void;
  /** What failed, and null when it did not. */
  readonly onProblem: (problem: string | null) => void;
}

export class Refined<Q, A> {
  private wanted: Q | null = null;
  private waits = false;
  private running = false;
  /** What only makes sense while nothing moves. */
  private still = new AbortController();

  constructor(private readonly asking: Asking<Q, A>) {}

  /** What is asked from now on; null for nothing. While another question is awaited, the full answer to this one ``waits``. */
  want(question: Q | null, waits = false): void {
    const isSame = JSON.stringify(question) === JSON.stringify(this.wanted);
    if (isSame && waits === this.waits) return;
    this.waits = waits;
    this.still.abort();
    if (isSame) return;
    this.wanted = question;
    this.asking.onBehind(question !== null);
    if (!this.running) void this.run();
  }

  private async run(): Promise<void> {
    this.running = true;
    let question = this.wanted;
    while (question !== null) {
      const came = await this.fetch(question, true, new AbortController().signal);
      while (came && this.wanted === question && !(await this.refine(question)));
      if (this.wanted === question) break;
      question = this.wanted;
    }
    this.running = false;
  }

  /** Whether the full answer came, or failed, before anything changed. */
  private async refine(question: Q): Promise<boolean> {
    this.still = new AbortController();
    const { signal } = this.still;
    await new Promise((resolve) => {
      const timer = this.waits ? undefined : setTimeout(resolve, STILL);
      signal.addEventListener("abort", () => {
        clearTimeout(timer);
        resolve(null);
      });
    });
    if (signal.aborted) return false;
    if (await this.fetch(question, false, signal)) this.asking.onBehind(false);
    return !signal.aborted;
  }

  /** Whether an answer came. */
  private async fetch(question: Q, draft: boolean, signal: AbortSignal): Promise<boolean> {
    try {
      const answer = await this.asking.ask(question, draft, signal);
      if (this.wanted === null || signal.aborted) return false;
      this.asking.onAnswer(answer, draft);
      this.asking.onProblem(null);
      return true;
    } catch (error) {
      if (!signal.aborted) this.asking.onProblem((error as Error).message);
      return false;
    }
  }
}
