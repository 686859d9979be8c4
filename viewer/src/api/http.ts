// Asking the server that served the page.

import { type Client, Later } from "./client";
import { type Ask, adder, clientOver } from "./requests";

const AWAY =
  "The server does not answer: is `halfway view` still running in its terminal? What is shown stays, and the page goes on when it answers.";

const HALF_BYTES = 2;

const ask: Ask = async ({ method, path, body, signal, onProgress }) => {
  const answer = await fetched(path, {
    method,
    ...(body !== undefined && { body, headers: { "Content-Type": "application/json" } }),
    ...(signal && { signal }),
  });
  return { status: answer.status, headers: new Map(answer.headers), body: await read(answer, onProgress) };
};

export const http: Client = { ...clientOver(ask), add: adder(ask) };

async function fetched(path: string, options: RequestInit): Promise<Response> {
  try {
    return await fetch(path, options);
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Later(AWAY);
  }
}

/** The body, its arrival told as it comes where its length is known. */
export async function read(answer: Response, onProgress?: (share: number) => void): Promise<ArrayBuffer> {
  try {
    return await body(answer, onProgress);
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Later("An answer broke off on its way: it is asked for again.");
  }
}

async function body(answer: Response, onProgress?: (share: number) => void): Promise<ArrayBuffer> {
  const length = lengthOf(answer.headers);
  if (!onProgress || !length || answer.body === null) return answer.arrayBuffer();
  const bytes = new Uint8Array(length);
  let at = 0;
  const reader = answer.body.getReader();
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    bytes.set(part.value, at);
    at += part.value.length;
    onProgress(at / length);
  }
  return bytes.buffer;
}

/** Bytes of the body when it is unpacked; 0 where nobody says. */
function lengthOf(headers: Headers): number {
  const shape = headers.get("Halfway-Shape");
  if (shape) return shape.split(",").reduce((product, n) => product * Number(n), HALF_BYTES);
  return headers.get("Content-Encoding") ? 0 : Number(headers.get("Content-Length"));
}
