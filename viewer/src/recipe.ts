// Recipes: materials and their weights, in each channel.

import type { RecipeDocument } from "./api/schema";
import { bodyScale, type Mixing, PLAIN } from "./blend";

export const CHANNELS = ["r", "g", "b"] as const;

/** One material of a recipe. */
export interface Ingredient {
  readonly name: string;
  readonly weight: readonly [number, number, number];
}

/** The JSON document, as `halfway mix` reads it; one map of weights where the channels are the same. */
export function toDocument(
  library: string,
  recipe: readonly Ingredient[],
  mixing: Mixing = PLAIN,
): RecipeDocument {
  const [r, g, b] = CHANNELS.map((_, c) =>
    Object.fromEntries(
      recipe.filter(({ weight }) => weight[c]! > 0).map(({ name, weight }) => [name, weight[c]!]),
    ),
  );
  const same = recipe.every(({ weight: [x, y, z] }) => x === y && y === z);
  const scale = bodyScale(mixing);
  return {
    library,
    blend: mixing.blend,
    weights: same ? r! : { r: r!, g: g!, b: b! },
    ...(scale && { body_scale: scale }),
  };
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

/** The materials of recipes, each once. */
export function namesIn(...recipes: readonly (readonly Ingredient[])[]): string[] {
  return [...new Set(recipes.flat().map(({ name }) => name))];
}

/** One material alone. */
export function only(name: string): Ingredient[] {
  return [{ name, weight: [1, 1, 1] }];
}

/** The weight in one channel, or the mean of all. */
export function weightIn(ingredient: Ingredient, channel: (typeof CHANNELS)[number] | "all"): number {
  return channel === "all" ? meanWeight(ingredient) : ingredient.weight[CHANNELS.indexOf(channel)]!;
}

export function meanWeight({ weight: [r, g, b] }: Ingredient): number {
  return (r + g + b) / 3;
}
