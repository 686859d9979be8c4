// A folder of files that any static host serves (halfway.server.static), instead of a server.

import { locate } from "../charts";
import { pointOf } from "../coordinates";
import { fromDocument, toDocument } from "../recipe";
import { type Block, type Client, Later, Problem } from "./client";
import { read } from "./http";
import type { AlikeFile, BlockFile, ChartView, Folder, PositionView, SpaceView } from "./schema";

export function files(base: string): Client {
  const kept = new Map<string, Promise<unknown>>();
  /** A file that is asked for once, or again when it did not come. */
  const json = <T>(path: string): Promise<T> => {
    const known = kept.get(path) ?? fetched(`${base}${path}`).then((answer) => answer.json());
    kept.set(path, known);
    known.catch(() => kept.delete(path));
    return known as Promise<T>;
  };
  const folder = () => json<Folder>("explorer.json");
  const names = async () => (await folder()).library.materials.map(({ name }) => name);
  const spaceView = (space: string) => json<SpaceView>(`spaces/${space}.json`);
  return {
    library: async () => (await folder()).library,
    spaceView,
    // Its one blend is linear.
    leg: async (space, _, start, stop) => {
      const all = await names();
      return json(`legs/${space}/${all.indexOf(start)}-${all.indexOf(stop)}.json`);
    },
    at: async (space, _, point) => {
      const { charts } = await json<{ charts: ChartView[] }>(`charts/${space}.json`);
      return position(await spaceView(space), charts, (await folder()).library.name, await names(), point);
    },
    attributes: () => json("attributes.json"),
    alike: async (recipe) => {
      const [only, ...others] = fromDocument(recipe);
      if (!only || others.length) throw new Problem(OF_MATERIALS);
      const { distances } = await json<AlikeFile>("alike.json");
      return { distances: distances[(await names()).indexOf(only.name)]! };
    },
    thumbnails: async () => ({
      bytes: new Uint8Array(await unpacked(`${base}thumbnails.bin`)),
      shape: (await folder()).thumbnails.shape,
    }),
    environment: async () => block(`${base}environment.bin`, (await folder()).environment),
    table: async (name, onProgress) => {
      const i = (await names()).indexOf(name);
      return block(`${base}tables/${i}.bin`, (await folder()).tables[i]!, onProgress);
    },
    mixed: cannotMix,
    thumbnailsOf: cannotMix,
    exported: cannotMix,
  };
}

const OF_MATERIALS =
  "Files know how alike people find the materials, and not mixes: go to a stop, or open the library with `halfway view`.";

async function cannotMix(): Promise<never> {
  throw new Problem("Files cannot mix tables: save the recipe, and `halfway mix` makes its table.");
}

/** The material at a point, or a mix nearby; one chart is for all channels. */
export function position(
  view: SpaceView,
  charts: readonly ChartView[],
  library: string,
  names: readonly string[],
  point: readonly number[],
): PositionView {
  const size = point.length / charts.length;
  const located = charts.map((chart, c) => locate(chart, point.slice(c * size, (c + 1) * size)));
  const weight = (i: number, c: number) => {
    const { vertices, weights } = located[c % located.length]!;
    return weights[vertices.indexOf(i)] ?? 0;
  };
  const recipe = names
    .map((name, i) => ({ name, weight: [weight(i, 0), weight(i, 1), weight(i, 2)] as const }))
    .filter(({ weight }) => weight.some((w) => w > 0));
  const inside = located.every((each) => each.inside);
  return { recipe: toDocument(library, recipe), point: pointOf(view, names, recipe), inside };
}

async function block(
  path: string,
  { shape, scale }: BlockFile,
  onProgress?: (share: number) => void,
): Promise<Block> {
  return { halfs: new Uint16Array(await unpacked(path, onProgress)), shape, scale };
}

async function unpacked(path: string, onProgress?: (share: number) => void): Promise<ArrayBuffer> {
  const packed = await read(await fetched(path), onProgress);
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

async function fetched(path: string): Promise<Response> {
  const answer = await fetch(path).catch(() => {
    if (location.protocol !== "file:") throw new Later(`${path} cannot be read now: it is asked for again.`);
    throw new Problem(
      `${path} cannot be read: a page opened as a file may read no others, so serve the folder.`,
    );
  });
  if (answer.ok) return answer;
  throw new Problem(`${path} is not there (${answer.status}): copy the whole folder that was exported.`);
}
