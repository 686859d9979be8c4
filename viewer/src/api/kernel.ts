// Asking a notebook's kernel, over the widget's own messages: halfway.notebook.Explorer answers with the server's API.
//
//   to the kernel     {id, method, path, body}
//   from the kernel   {id, status, headers} and one buffer, the body

import { type Client, Problem } from "./client";
import { type Answer, clientOver, type Request } from "./requests";

/** What of a widget's model messages take. */
export interface Messenger {
  send(content: unknown): void;
  on(event: "msg:custom", listener: (content: unknown, buffers: readonly DataView[]) => void): void;
}

interface Reply {
  readonly id: number;
  readonly status: number;
  readonly headers: Readonly<Record<string, string>>;
}

interface Waiting {
  readonly resolve: (answer: Answer) => void;
  readonly request: Request;
}

export function kernel(messenger: Messenger): Client {
  const waiting = new Map<number, Waiting>();
  // Several views of one widget hear the same answers: numbers are unlikely to meet.
  let id = Math.floor(Math.random() * 2 ** 40);
  messenger.on("msg:custom", (content, buffers) => {
    const { id, status, headers } = content as Reply;
    const asked = waiting.get(id);
    if (asked === undefined) return;
    waiting.delete(id);
    asked.request.onProgress?.(1);
    asked.resolve({ status, headers: new Map(Object.entries(headers)), body: bytes(buffers[0]) });
  });
  return clientOver((request) => {
    const { method, path, body, signal } = request;
    id++;
    const mine = id;
    return new Promise((resolve, reject) => {
      signal?.throwIfAborted();
      signal?.addEventListener("abort", () => {
        waiting.delete(mine);
        reject(signal.reason);
      });
      waiting.set(mine, { resolve, request });
      try {
        messenger.send({ id: mine, method, path, body: body ?? null });
      } catch {
        waiting.delete(mine);
        reject(new Problem("The kernel does not answer: run the cell of this explorer again."));
      }
    });
  });
}

function bytes(view: DataView | undefined): ArrayBuffer {
  if (view === undefined) return new ArrayBuffer(0);
  // A copy: messages share one buffer, at offsets that need not suit 16-bit numbers.
  return view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength) as ArrayBuffer;
}
