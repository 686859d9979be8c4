// Asking the server. A mistake comes back as {"error": "one line"} and is thrown as a `Problem`.

import type { LibrarySummary, PlaceView, RecipeDocument, RouteView, SpaceView } from "./schema";

const JSON_HEADERS = { "Content-Type": "application/json" };

export class Problem extends Error {}

export interface Block {
  readonly halfs: Uint16Array<ArrayBuffer>;
  readonly shape: readonly number[];
  readonly scale: readonly [number, number, number];
}

/** What the page asks for; every failure that a person can act on is a `Problem`. */
export interface Client {
  readonly library: () => Promise<LibrarySummary>;
  readonly spaceView: (space: string) => Promise<SpaceView>;
  readonly route: (
    space: string,
    pace: string,
    stops: readonly string[],
    signal: AbortSignal,
  ) => Promise<RouteView>;
  readonly place: (space: string, point: readonly number[], signal: AbortSignal) => Promise<PlaceView>;
  readonly thumbnails: () => Promise<Block>;
  readonly environment: () => Promise<Block>;
  /** One material's table; `onProgress` is told the share that has come, in [0, 1]. */
  readonly table: (name: string, onProgress?: (share: number) => void) => Promise<Block>;
  /** The mixed table as a file, in one of the library's `exports`. */
  readonly exported: (format: string, recipe: RecipeDocument) => Promise<Blob>;
}

/** The server that served the page. */
export const http: Client = {
  library: () => json("api/library"),
  spaceView: (space) => json(`api/spaces/${encodeURIComponent(space)}`),
  route: (space, pace, stops, signal) => {
    const query = new URLSearchParams({ space, pace });
    for (const stop of stops) query.append("stop", stop);
    return json(`api/route?${query}`, { signal });
  },
  place: (space, point, signal) =>
    json("api/place", {
      method: "POST",
      headers: JSON_HEADERS,
      body: JSON.stringify({ space, point }),
      signal,
    }),
  thumbnails: () => block("api/thumbnails"),
  environment: () => block("api/environment"),
  table: (name, onProgress) => block(`api/tables/${encodeURIComponent(name)}`, onProgress),
  exported: async (format, recipe) => {
    const path = `api/export/${encodeURIComponent(format)}`;
    const answer = await ask(path, { method: "POST", headers: JSON_HEADERS, body: JSON.stringify(recipe) });
    return answer.blob();
  },
};

async function json<T>(path: string, options: RequestInit = {}): Promise<T> {
  return (await ask(path, options)).json() as Promise<T>;
}

async function block(path: string, onProgress: (share: number) => void = () => {}): Promise<Block> {
  const answer = await ask(path, {});
  const numbers = (header: string) => (answer.headers.get(header) ?? "").split(",").map(Number);
  const [r = 1, g = 1, b = 1] = numbers("Halfway-Scale");
  const halfs = new Uint16Array(await read(answer, onProgress));
  return { halfs, shape: numbers("Halfway-Shape"), scale: [r, g, b] };
}

/** The body, its arrival told as it comes where its length is known. */
async function read(answer: Response, onProgress: (share: number) => void): Promise<ArrayBuffer> {
  const length = Number(answer.headers.get("Content-Length"));
  if (!length || answer.headers.get("Content-Encoding") || answer.body === null) return answer.arrayBuffer();
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

async function ask(path: string, options: RequestInit): Promise<Response> {
  let answer: Response;
  try {
    answer = await fetch(path, options);
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Problem("The server does not answer: is `halfway view` still running in its terminal?");
  }
  if (answer.ok) return answer;
  const text = await answer.text();
  throw new Problem(errorIn(text) ?? `The server answered ${answer.status} to ${path}.`);
}

function errorIn(text: string): string | undefined {
  try {
    return (JSON.parse(text) as { error?: string }).error;
  } catch {
    return undefined;
  }
}
