// How the weighted materials of a recipe become one: a name, and the function in which weighted sums are taken
// (halfway.recipes.blend). Pictures mix as materials do where that is the identity, and nowhere else.

/** Whose pictures mix: the page makes them of the materials' own. */
export const LINEAR = "linear";

interface Mapping {
  readonly to: (f: number) => number;
  readonly back: (mapped: number) => number;
}

const IDENTITY: Mapping = { to: (f) => f, back: (f) => f };
const ROOT: Mapping = { to: Math.sqrt, back: (f) => f * f };
const MAPPINGS: Readonly<Record<string, Mapping>> = {
  root: ROOT,
  lobes: ROOT,
  log: { to: Math.log1p, back: Math.expm1 },
};

/** The mapping of a blend, in which the coordinates of its spaces are. */
export function mappingOf(blend: string): Mapping {
  return MAPPINGS[blend] ?? IDENTITY;
}
