// A route: the legs between its stops one after another, and the recipe at any t.
//
// A leg is the way from one material to another, as weights at knots; it takes a share of t as large as its length is beside the
// others', at a pace (halfway.space). The page asks for legs and for nothing else, whoever answers.

import type { LegView, WeightTable } from "./api/schema";
import { LINEAR } from "./blend";
import { sum } from "./numbers";
import { CHANNELS, type Ingredient } from "./recipe";

/** Weights at knots, between which they are linear in t. */
export interface Route {
  /** How its recipes are mixed. */
  readonly blend: string;
  readonly names: readonly string[];
  readonly knots: readonly number[];
  readonly weights: WeightTable;
  /** Where each stop is. */
  readonly stops: readonly number[];
  /** The knots at which the set of materials that carry weight changes, in any channel. */
  readonly crossings: readonly number[];
}

/** The route along `legs` at a pace; `order` has all materials. */
export function join(
  legs: readonly LegView[],
  pace: string,
  order: readonly string[],
  blend: string = LINEAR,
): Route {
  const used = new Set(legs.flatMap(({ names }) => names));
  const names = order.filter((name) => used.has(name));
  const paced = legs.map((leg) => atPace(leg, pace));
  const total = sum(paced.map(({ length }) => length));
  let start = 0;
  const stops = [0, ...paced.map(({ length }) => (start += length / total))];
  // The last knot of a leg is the first of the next.
  const inner = <T>(values: readonly T[], i: number) => (i < legs.length - 1 ? values.slice(0, -1) : values);
  const knots = paced.flatMap(({ lengths }, i) => inner(lengths, i).map((x) => stops[i]! + x / total));
  const weights = perChannel((channel) =>
    legs.flatMap((leg, i) => {
      const column = names.map((name) => leg.names.indexOf(name));
      return inner(paced[i]!.ts, i).map((t) => {
        const row = between(leg.knots, leg.weights[channel], t);
        return column.map((k) => (k < 0 ? 0 : row[k]!));
      });
    }),
  );
  stops[legs.length] = knots[knots.length - 1] = 1;
  return { blend, names, knots, weights, stops, crossings: crossings(knots, weights) };
}

/** The same way back. */
export function reversed({ names, knots, weights, paces }: LegView): LegView {
  const back = (ts: readonly number[], end = 1) => ts.map((t) => end - t).reverse();
  return {
    names,
    knots: back(knots),
    weights: perChannel((channel) => weights[channel].toReversed()),
    paces: Object.fromEntries(
      Object.entries(paces).map(([pace, { t, length }]) => [
        pace,
        { t: back(t), length: back(length, length.at(-1)) },
      ]),
    ),
  };
}

/** The materials that carry weight at t, in the order of the route's names. */
export function recipeAt({ names, knots, weights }: Route, t: number): Ingredient[] {
  const [r, g, b] = CHANNELS.map((channel) => between(knots, weights[channel], t));
  return names
    .map((name, i) => ({ name, weight: [r![i]!, g![i]!, b![i]!] as const }))
    .filter(({ weight }) => weight.some((w) => w > 0));
}

/** The t of a leg at which its weights or its pace change, and how long it is up to each. */
function atPace({ knots, paces }: LegView, pace: string) {
  const { t, length } = paces[pace]!;
  const ts = [...new Set([...knots, ...t])].sort((a, b) => a - b);
  const column = length.map((x) => [x]);
  return { ts, lengths: ts.map((x) => between(t, column, x)[0]!), length: length.at(-1)! };
}

/** Rows at knots, interpolated. */
function between(knots: readonly number[], rows: readonly (readonly number[])[], t: number): number[] {
  let piece = 0;
  while (piece < knots.length - 2 && t >= knots[piece + 1]!) piece++;
  const [from, to] = [knots[piece]!, knots[piece + 1]!];
  const share = (t - from) / (to - from);
  const next = rows[piece + 1]!;
  return rows[piece]!.map((x, i) => (1 - share) * x + share * next[i]!);
}

function perChannel<T>(of: (channel: (typeof CHANNELS)[number]) => T): { r: T; g: T; b: T } {
  return { r: of("r"), g: of("g"), b: of("b") };
}

function crossings(knots: readonly number[], weights: WeightTable): number[] {
  const carried = (k: number) => {
    const rows = CHANNELS.map((channel) => [weights[channel][k]!, weights[channel][k + 1]!] as const);
    return rows.map(([from, to]) => from.map((w, i) => (w > 0 || to[i]! > 0 ? "1" : "0")).join("")).join();
  };
  return knots.slice(1, -1).filter((_, k) => carried(k) !== carried(k + 1));
}
