// Points of a space: the coordinates of all its embeddings, one after another.

import type { SpaceView } from "./api/schema";
import { type Ingredient, weightIn } from "./recipe";

/** The point of a mix is the mix of the points. */
export function pointOf(view: SpaceView, names: readonly string[], recipe: readonly Ingredient[]): number[] {
  return view.embeddings.flatMap((embedding) => mixedPoint(embedding, names, recipe));
}

/** The coordinates of a mix in one embedding, whose points are in the order of `names`. */
export function mixedPoint(
  { axes, points, channel }: SpaceView["embeddings"][number],
  names: readonly string[],
  recipe: readonly Ingredient[],
): number[] {
  const sum = axes.map(() => 0);
  for (const ingredient of recipe) {
    const weight = weightIn(ingredient, channel);
    points[names.indexOf(ingredient.name)]?.forEach((x, axis) => {
      sum[axis]! += weight * x;
    });
  }
  return sum;
}

/** A point with the first coordinates of one embedding replaced. */
export function withCoordinates(
  view: SpaceView,
  point: readonly number[],
  embedding: string,
  coordinates: readonly number[],
): number[] {
  const [from] = rangeOf(view, embedding);
  return [...point.slice(0, from), ...coordinates, ...point.slice(from + coordinates.length)];
}

/** The coordinates of one embedding in a point. */
export function coordinatesIn(view: SpaceView, point: readonly number[], embedding: string): number[] {
  return point.slice(...rangeOf(view, embedding));
}

/** Where the coordinates of an embedding are in a point; none when the space does not have it. */
function rangeOf({ embeddings }: SpaceView, name: string): [number, number] {
  let from = 0;
  for (const embedding of embeddings) {
    const to = from + embedding.axes.length;
    if (embedding.name === name) return [from, to];
    from = to;
  }
  return [from, from];
}
