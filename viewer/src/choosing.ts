// Which materials fit what is searched and chosen: they are listed, stand in the grid, and are lit in the space.

import type { Context } from "./context";
import { type Described, described, fits, likeness, matching } from "./materials";
import { only, toDocument } from "./recipe";
import { GRID, type State } from "./state";

export function followChoice(context: Context): void {
  const { store, names, thumbnails } = context;
  store.watch(["pictured", "attributes"], ({ attributes }) => {
    const [gloss, width] = ["gloss60", "highlight_width"].map(
      (name) => attributes?.find((each) => each.name === name)?.values,
    );
    // What has no highlight has none that is narrow.
    const shine = (i: number) =>
      gloss && { gloss60: gloss[i] ?? 0, width: width?.[i] ?? Number.POSITIVE_INFINITY };
    store.set({
      described: names.map((name, i) => described(name, thumbnails.mean(only(name)), shine(i) ?? null)),
    });
  });
  followLikeness(context);
  store.watch(["described", "query", "facets", "map", "alike"], (state) =>
    store.set({ matches: matches(state) }),
  );
}

/** How people find the materials beside the one that the search names. */
function followLikeness({ client, store, actions }: Context): void {
  store.watch(["described", "query"], ({ described, query, alike, library }) => {
    const asked = likeness(query);
    const to = asked && (matching(described, asked.like)[0] ?? null);
    if (to === (alike?.to ?? null)) return;
    store.set({ alike: to === null ? null : { to, distances: null } });
    if (to === null) return;
    const isAsked = () => store.get().alike?.to === to;
    client.alike(toDocument(library.name, only(to))).then(
      ({ distances }) => isAsked() && store.set({ alike: { to, distances } }),
      (error: Error) => isAsked() && actions.say("space", "likeness", error.message),
    );
  });
}

/** What is searched is searched among all. */
function matches({ described, query, facets, map, alike }: State): readonly string[] | null {
  const asked = likeness(query);
  if (asked) return alike?.distances ? mostAlike(described, asked.words, alike.to, alike.distances) : [];
  if (query.trim()) return matching(described, query);
  if (map !== GRID || !Object.values(facets).some(Boolean)) return null;
  return described.filter((each) => fits(each, facets)).map(({ name }) => name);
}

/** So many are alike. */
const N_ALIKE = 12;

/** Of those that fit the words, those that people find least different from a material; without itself. */
function mostAlike(
  described: readonly Described[],
  words: string,
  to: string,
  distances: readonly number[],
): string[] {
  const fitting = new Set(words ? matching(described, words) : described.map(({ name }) => name));
  return described
    .map(({ name }, i) => ({ name, distance: distances[i]! }))
    .filter(({ name }) => name !== to && fitting.has(name))
    .sort((a, b) => a.distance - b.distance)
    .slice(0, N_ALIKE)
    .map(({ name }) => name);
}
