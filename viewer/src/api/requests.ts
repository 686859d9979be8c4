// The server's API as a `Client`, over anything that carries requests: see halfway.server.app.
// A mistake comes back as {"error": "one line"} and is thrown as a `Problem`.

import { type Block, type Client, Later, type Pictures, Problem } from "./client";
import type { Added, NotYet } from "./schema";

export interface Request {
  readonly method: "GET" | "POST";
  readonly path: string;
  /** JSON, or a file where the server is asked over HTTP. */
  readonly body?: string | File;
  readonly signal?: AbortSignal;
  readonly onProgress?: (share: number) => void;
}

export interface Answer {
  readonly status: number;
  /** By their names in lower case. */
  readonly headers: ReadonlyMap<string, string>;
  readonly body: ArrayBuffer;
}

export type Ask = (request: Request) => Promise<Answer>;

export function clientOver(ask: Ask): Client {
  const get = (path: string, signal?: AbortSignal) =>
    said(ask, { method: "GET", path, ...(signal && { signal }) });
  const post = (path: string, body: unknown, signal?: AbortSignal) =>
    said(ask, { method: "POST", path, body: JSON.stringify(body), ...(signal && { signal }) });
  return {
    library: async () => json(await get("api/library")),
    spaceView: async (space, blend) =>
      json(await get(`api/spaces/${encodeURIComponent(space)}?blend=${blend}`)),
    leg: async (space, blend, start, stop, pace, signal) => {
      const way = [space, start, stop].map(encodeURIComponent).join("/");
      return json(await get(`api/legs/${way}?blend=${blend}&pace=${pace}`, signal));
    },
    at: async (space, blend, point, signal) =>
      json(await post("api/position", { space, blend, point }, signal)),
    attributes: async () => json(await get("api/attributes")),
    alike: async (recipe) => json(await post("api/alike", recipe)),
    find: async (wanted, signal) => json(await post("api/find", wanted, signal)),
    perceived: async (recipe, signal) => json(await post("api/perceived", recipe, signal)),
    mixed: async (recipe, small, signal) => block(await post(`api/mix?small=${small}`, recipe, signal)),
    thumbnailsOf: async (recipes) => pictures(await post("api/thumbnails", recipes)),
    thumbnails: async () => pictures(await get("api/thumbnails")),
    environment: async () => block(await get("api/environment")),
    table: async (name, onProgress = () => {}) =>
      block(await said(ask, { method: "GET", path: `api/tables/${encodeURIComponent(name)}`, onProgress })),
    exported: async (format, recipe) => {
      const { headers, body } = await post(`api/export/${encodeURIComponent(format)}`, recipe);
      return { file: new Blob([body]), summary: decodeURIComponent(headers.get("halfway-summary") ?? "") };
    },
  };
}

/** Takes a file in by an `Ask` that carries files. */
export function adder(ask: Ask): NonNullable<Client["add"]> {
  return async (file) =>
    json<Added>(
      await said(ask, { method: "POST", path: `api/materials/${encodeURIComponent(file.name)}`, body: file }),
    ).name;
}

async function said(ask: Ask, request: Request): Promise<Answer> {
  const answer = await ask(request);
  if (answer.status === 202) {
    const { error, progress } = json<NotYet>(answer);
    throw new Later(error, true, progress);
  }
  if (answer.status >= 200 && answer.status < 300) return answer;
  throw new Problem(errorIn(answer) ?? `The server answered ${answer.status} to ${request.path}.`);
}

function json<T>({ body }: Answer): T {
  return JSON.parse(new TextDecoder().decode(body)) as T;
}

function block(answer: Answer): Block {
  const [r = 1, g = 1, b = 1] = numbers(answer, "halfway-scale");
  return { halfs: new Uint16Array(answer.body), shape: numbers(answer, "halfway-shape"), scale: [r, g, b] };
}

function pictures(answer: Answer): Pictures {
  return { bytes: new Uint8Array(answer.body), shape: numbers(answer, "halfway-shape") };
}

function numbers({ headers }: Answer, header: string): number[] {
  return (headers.get(header) ?? "").split(",").map(Number);
}

function errorIn(answer: Answer): string | undefined {
  try {
    return json<{ error?: string }>(answer).error;
  } catch {
    return undefined;
  }
}
