// Places of a space: the coordinates of all its embeddings, one after another.

import type { RecipeDocument, SpaceView } from "./api/schema";
import { CHANNELS, type Ingredient, weightIn } from "./recipe";

/** The point of a mix is the mix of the points. */
export function pointOf(view: SpaceView, names: readonly string[], recipe: readonly Ingredient[]): number[] {
  const indices = new Map(names.map((name, i) => [name, i]));
  return view.embeddings.flatMap(({ axes, points, channel }) =>
    axes.map((_, axis) =>
      recipe.reduce((sum, ingredient) => {
        const point = points[indices.get(ingredient.name)!]!;
        return sum + weightIn(ingredient, channel) * point[axis]!;
      }, 0),
    ),
  );
}

/** A point with the coordinates of one embedding replaced. */
export function withCoordinates(
  view: SpaceView,
  point: readonly number[],
  embedding: string,
  coordinates: readonly number[],
): number[] {
  let start = 0;
  for (const { name, axes } of view.embeddings) {
    if (name === embedding)
      return [...point.slice(0, start), ...coordinates, ...point.slice(start + axes.length)];
    start += axes.length;
  }
  return [...point];
}

/** The coordinates of one embedding in a point. */
export function coordinatesIn(view: SpaceView, point: readonly number[], embedding: string): number[] {
  let start = 0;
  for (const { name, axes } of view.embeddings) {
    if (name === embedding) return point.slice(start, start + axes.length);
    start += axes.length;
  }
  return [];
}

/** Has the space places between its routes? */
export function hasPlaces(view: SpaceView | null): boolean {
  return view !== null && view.name !== "linear";
}

export function fromDocument({ weights }: RecipeDocument): Ingredient[] {
  const channels = CHANNELS.map((channel) => {
    const own = (weights as Record<string, unknown>)[channel];
    return (typeof own === "object" ? own : weights) as Readonly<Record<string, number>>;
  });
  const names = [...new Set(channels.flatMap((channel) => Object.keys(channel)))];
  return names.map((name) => {
    const [r = 0, g = 0, b = 0] = channels.map((channel) => channel[name] ?? 0);
    return { name, weight: [r, g, b] };
  });
}
