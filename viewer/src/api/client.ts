// Asking the server. A mistake comes back as {"error": "one line"} and is thrown as a `Problem`.

import type { LibrarySummary, PlaceView, RecipeDocument, RouteView, SpaceView } from "./schema";

const JSON_HEADERS = { "Content-Type": "application/json" };

export class Problem extends Error {}

export interface Block {
  readonly halfs: Uint16Array<ArrayBuffer>;
  readonly shape: readonly number[];
  readonly scale: readonly [number, number, number];
}

export const library = (): Promise<LibrarySummary> => json("api/library");

export const spaceView = (space: string): Promise<SpaceView> =>
  json(`api/spaces/${encodeURIComponent(space)}`);

export function route(
  space: string,
  pace: string,
  stops: readonly string[],
  signal: AbortSignal,
): Promise<RouteView> {
  const query = new URLSearchParams({ space, pace });
  for (const stop of stops) query.append("stop", stop);
  return json(`api/route?${query}`, { signal });
}

export const thumbnails = (): Promise<Block> => block("api/thumbnails");

export const environment = (): Promise<Block> => block("api/environment");

export const table = (name: string): Promise<Block> => block(`api/tables/${encodeURIComponent(name)}`);

export function place(space: string, point: readonly number[], signal: AbortSignal): Promise<PlaceView> {
  return json("api/place", {
    method: "POST",
    headers: JSON_HEADERS,
    body: JSON.stringify({ space, point }),
    signal,
  });
}

/** The mixed table as a file, in one of the library's `exports`. */
export async function exported(format: string, recipe: RecipeDocument): Promise<Blob> {
  const path = `api/export/${encodeURIComponent(format)}`;
  const answer = await ask(path, { method: "POST", headers: JSON_HEADERS, body: JSON.stringify(recipe) });
  return answer.blob();
}

async function json<T>(path: string, options: RequestInit = {}): Promise<T> {
  return (await ask(path, options)).json() as Promise<T>;
}

async function block(path: string): Promise<Block> {
  const answer = await ask(path, {});
  const numbers = (header: string) => (answer.headers.get(header) ?? "").split(",").map(Number);
  const [r = 1, g = 1, b = 1] = numbers("Halfway-Scale");
  const halfs = new Uint16Array(await answer.arrayBuffer());
  return { halfs, shape: numbers("Halfway-Shape"), scale: [r, g, b] };
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
