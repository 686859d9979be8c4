// A folder of files that any static host serves (halfway.server.static), instead of a server: routes are joined and places found
// in the page.

import { pointOf } from "../coordinates";
import { type Ingredient, toDocument } from "../recipe";
import { join, reversed } from "../space/legs";
import { nearest, weightsAt } from "../space/triangulation";
import { type Block, type Client, Problem } from "./client";
import { read } from "./http";
import type { BlockFile, Folder, LegFile, PlaceView, SpaceFile, SpaceView } from "./schema";

/** A place counts as reached within this share of the extent of each coordinate: halfway.server.explorer. */
const INSIDE = 1e-6;

export function files(base: string): Client {
  const json = <T>(path: string, signal?: AbortSignal) =>
    fetched(`${base}${path}`, signal).then((answer) => answer.json() as Promise<T>);
  const folder = json<Folder>("explorer.json");
  // What goes wrong here is said by whoever asks first.
  folder.catch(() => {});
  const spaces = new Map<string, Promise<SpaceFile>>();
  const space = (name: string) => {
    const known = spaces.get(name) ?? json<SpaceFile>(`spaces/${name}.json`);
    spaces.set(name, known);
    known.catch(() => spaces.delete(name));
    return known;
  };
  const names = async () => (await folder).library.materials.map(({ name }) => name);
  return {
    library: async () => (await folder).library,
    spaceView: async (name) => (await space(name)).view,
    route: async (name, pace, stops, signal) => {
      const all = await names();
      const legs = stops
        .slice(1)
        .map((stop, i) => leg(json, name, all.indexOf(stops[i]!), all.indexOf(stop), signal));
      const { library } = await folder;
      return join({ library: library.name, space: name, pace, stops, names: all }, await Promise.all(legs));
    },
    at: async (name, point) => placed(await space(name), (await folder).library.name, await names(), point),
    thumbnails: async () => block(`${base}thumbnails.bin`, (await folder).thumbnails),
    environment: async () => block(`${base}environment.bin`, (await folder).environment),
    table: async (name, onProgress) => {
      const i = (await names()).indexOf(name);
      return block(`${base}tables/${i}.bin`, (await folder).tables[i]!, onProgress);
    },
    exported: async () => {
      throw new Problem("Files cannot mix tables: save the recipe, and `halfway mix` makes its table.");
    },
  };
}

async function leg(
  json: <T>(path: string, signal?: AbortSignal) => Promise<T>,
  space: string,
  from: number,
  to: number,
  signal: AbortSignal,
): Promise<LegFile> {
  if (from < to) return json(`legs/${space}/${from}-${to}.json`, signal);
  return reversed(await json<LegFile>(`legs/${space}/${to}-${from}.json`, signal));
}

/** The material at a place, as halfway.server.explorer finds it. */
export function placed(
  { view, triangulations }: SpaceFile,
  library: string,
  names: readonly string[],
  point: readonly number[],
): PlaceView {
  if (triangulations.length === 0) {
    throw new Problem(`the space '${view.name}' has no places between its routes: choose another space.`);
  }
  const size = point.length / triangulations.length;
  const weights = triangulations.map((triangulation, i) => {
    const place = point.slice(i * size, (i + 1) * size);
    return weightsAt(triangulation, place) ?? nearest(triangulation, place);
  });
  const recipe = toRecipe(names, weights);
  const reached = pointOf(view, names, recipe);
  const inside = extents(view).every((extent, k) => Math.abs(reached[k]! - point[k]!) <= INSIDE * extent);
  return { recipe: toDocument(library, recipe), point: reached, inside };
}

/** Weights over all materials, of all channels or of each, as a recipe. */
function toRecipe(names: readonly string[], weights: readonly (readonly number[])[]): Ingredient[] {
  const [r, g = r, b = r] = weights as readonly [number[], number[]?, number[]?];
  return names
    .map((name, i) => ({ name, weight: [r[i]!, g[i]!, b[i]!] as const }))
    .filter(({ weight }) => weight.some((w) => w > 0));
}

/** How far the materials extend along each coordinate, of one embedding after another. */
function extents({ embeddings }: SpaceView): number[] {
  return embeddings.flatMap(({ axes, points }) =>
    axes.map((_, k) => {
      const values = points.map((point) => point[k]!);
      return Math.max(...values) - Math.min(...values);
    }),
  );
}

async function block(
  path: string,
  { shape, scale }: BlockFile,
  onProgress?: (share: number) => void,
): Promise<Block> {
  const packed = await read(await fetched(path), onProgress);
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return { halfs: new Uint16Array(await new Response(unpacked).arrayBuffer()), shape, scale };
}

async function fetched(path: string, signal?: AbortSignal): Promise<Response> {
  let answer: Response;
  try {
    answer = await fetch(path, signal ? { signal } : {});
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Problem(
      `${path} cannot be read: a page opened as a file may read no others, so serve the folder.`,
    );
  }
  if (answer.ok) return answer;
  throw new Problem(`${path} is not there (${answer.status}): copy the whole folder that was exported.`);
}
