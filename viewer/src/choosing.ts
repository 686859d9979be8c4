// Which materials fit what is searched and chosen: they are listed, stand in the grid, and are lit in the space.

import type { Context } from "./context";
import { described, fits, matching } from "./materials";
import { only } from "./recipe";
import { GRID, type State } from "./state";

export function followChoice({ store, names, thumbnails }: Context): void {
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
  store.watch(["described", "query", "facets", "map"], (state) => store.set({ matches: matches(state) }));
}

/** What is searched is searched among all. */
function matches({ described, query, facets, map }: State): readonly string[] | null {
  if (query.trim()) return matching(described, query);
  if (map !== GRID || !Object.values(facets).some(Boolean)) return null;
  return described.filter((each) => fits(each, facets)).map(({ name }) => name);
}
