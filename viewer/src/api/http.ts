// Asking the server that served the page.

import { type Client, Problem } from "./client";
import { type Ask, clientOver } from "./requests";

const ask: Ask = async ({ method, path, body, signal, onProgress }) => {
  const answer = await fetched(path, {
    method,
    ...(body !== undefined && { body, headers: { "Content-Type": "application/json" } }),
    ...(signal && { signal }),
  });
  return { status: answer.status, headers: new Map(answer.headers), body: await read(answer, onProgress) };
};

export const http: Client = clientOver(ask);

async function fetched(path: string, options: RequestInit): Promise<Response> {
  try {
    return await fetch(path, options);
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Problem("The server does not answer: is `halfway view` still running in its terminal?");
  }
}

/** The body, its arrival told as it comes where its length is known. */
export async function read(answer: Response, onProgress?: (share: number) => void): Promise<ArrayBuffer> {
  try {
    return await body(answer, onProgress);
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Problem("An answer broke off on its way: reload the page to ask again.");
  }
}

async function body(answer: Response, onProgress?: (share: number) => void): Promise<ArrayBuffer> {
  const length = Number(answer.headers.get("Content-Length"));
  if (!onProgress || !length || answer.headers.get("Content-Encoding") || answer.body === null) {
    return answer.arrayBuffer();
  }
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
