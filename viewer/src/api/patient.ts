// A client that asks again: while an answer is being computed, and while nobody answers.

import { type Client, Later } from "./client";
import type { ProgressView } from "./schema";

/** What is waited for, in words; and the share of it that is done, where that is known. */
export interface Waiting {
  readonly text: string;
  readonly share: number | null;
  /** Whether it is being computed: else nobody answers. */
  readonly computed: boolean;
}

/** Milliseconds between two questions: for what is being computed, and where nobody answers. */
const COMPUTED = 400;
const AWAY = 1500;

/** The same client, until `signal` is aborted; what it waits for is told, and null when it waits no more. */
export function patient(
  client: Client,
  tell: (waiting: Waiting | null) => void,
  signal: AbortSignal,
): Client {
  const waiting = new Set<symbol>();
  const again =
    <A extends unknown[], R>(ask: (...parts: A) => Promise<R>) =>
    async (...parts: A): Promise<R> => {
      const question = Symbol();
      try {
        for (;;) {
          try {
            return await ask(...parts);
          } catch (error) {
            if (!(error instanceof Later)) throw error;
            waiting.add(question);
            tell(inWords(error));
            await new Promise((resolve) => setTimeout(resolve, error.computed ? COMPUTED : AWAY));
            signal.throwIfAborted();
          }
        }
      } finally {
        if (waiting.delete(question) && waiting.size === 0 && !signal.aborted) tell(null);
      }
    };
  return {
    library: again(client.library),
    spaceView: again(client.spaceView),
    leg: again(client.leg),
    at: again(client.at),
    attributes: again(client.attributes),
    alike: again(client.alike),
    ...(client.find && { find: again(client.find) }),
    ...(client.perceived && { perceived: again(client.perceived) }),
    thumbnails: again(client.thumbnails),
    environment: again(client.environment),
    mixed: again(client.mixed),
    thumbnailsOf: again(client.thumbnailsOf),
    table: again(client.table),
    // A person asked, and is there to be answered.
    exported: client.exported,
    ...(client.add && { add: client.add }),
  };
}

function inWords({ message, computed, progress }: Later): Waiting {
  if (progress === null) return { text: computed ? "Computing …" : message, share: null, computed };
  const { label, done, total } = progress;
  const text = `Computing: ${label.toLowerCase()}, ${done} of ${total}${timeLeft(progress)}`;
  return { text, share: done / Math.max(total, 1), computed };
}

function timeLeft({ done, total, seconds }: ProgressView): string {
  if (done < 2 || seconds < 2) return "";
  const left = (seconds * (total - done)) / done;
  return left < 90 ? `, about ${Math.ceil(left)} s left` : `, about ${Math.ceil(left / 60)} min left`;
}
