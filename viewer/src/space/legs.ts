// A route of the ways between its stops, as halfway.space.Route.through and halfway.space.perceptual make it.

import type { LegFile, RouteView, WeightTable } from "../api/schema";
import { CHANNELS, pieceAt } from "../recipe";

/** Length of a step in which nothing changes, as a share of the whole: halfway.space.pace. */
const LEAST = 1e-9;

type Table = readonly (readonly number[])[];

/** What of a route its legs do not say. */
export interface Way {
  readonly library: string;
  readonly space: string;
  readonly pace: string;
  readonly stops: readonly string[];
  /** All materials, in the library's order. */
  readonly names: readonly string[];
}

/** The route along `legs`, one for each stop but the first. */
export function join(way: Way, legs: readonly LegFile[]): RouteView {
  const used = new Set(legs.flatMap(({ names }) => names));
  const names = way.names.filter((name) => used.has(name));
  const spread = legs.map((leg) => ({ ...leg, weights: over(names, leg) }));
  const uniform = end(spread, ({ knots }) => knots);
  const stops = legs.map((_, i) => i / legs.length).concat(1);
  const { library, space, pace, stops: through } = way;
  const common = { library, space, pace, stops: [...through], names };
  if (pace !== "perceptual") {
    const weights = perChannel((channel) => end(spread, (leg) => leg.weights[channel], false));
    return { ...common, stop_t: stops, knots: uniform, weights, crossings: crossings(uniform, weights) };
  }
  const t = end(legs, ({ pace_t }) => pace_t);
  const u = shares(t, legs);
  const weights = perChannel((channel) =>
    end(spread, (leg) => leg.pace_t.map((at) => between(leg.knots, leg.weights[channel], at)), false),
  );
  return {
    ...common,
    stop_t: stops.map((at) => lookUp(t, u, at)),
    knots: u,
    weights,
    crossings: crossings(u, weights),
  };
}

/** The same way back. */
export function reversed(leg: LegFile): LegFile {
  const back = (ts: readonly number[]) => ts.map((t) => 1 - t).reverse();
  const whole = leg.pace_length.at(-1)!;
  return {
    names: leg.names,
    knots: back(leg.knots),
    weights: perChannel((channel) => [...leg.weights[channel]].reverse()),
    pace_t: back(leg.pace_t),
    pace_length: leg.pace_length.map((length) => whole - length).reverse(),
  };
}

function perChannel<T>(of: (channel: (typeof CHANNELS)[number]) => T): { r: T; g: T; b: T } {
  return { r: of("r"), g: of("g"), b: of("b") };
}

/** A leg's weights over all names of the route. */
function over(names: readonly string[], leg: LegFile): WeightTable {
  const column = names.map((name) => leg.names.indexOf(name));
  return perChannel((channel) => leg.weights[channel].map((row) => column.map((i) => (i < 0 ? 0 : row[i]!))));
}

/** One list of all legs' values: the last of a leg is the first of the next. Times take an equal share each. */
function end<L>(legs: readonly L[], of: (leg: L) => readonly number[]): number[];
function end<L, V>(legs: readonly L[], of: (leg: L) => readonly V[], times: false): V[];
function end<L>(legs: readonly L[], of: (leg: L) => readonly unknown[], times = true): unknown[] {
  const n = legs.length;
  return legs.flatMap((leg, i) => {
    const values = i < n - 1 ? of(leg).slice(0, -1) : of(leg);
    return times ? values.map((t) => (i + (t as number)) / n) : values;
  });
}

/** The share of its length that the route has covered at each t. */
function shares(t: readonly number[], legs: readonly LegFile[]): number[] {
  const steps = legs.flatMap(({ pace_length }) => pace_length.slice(1).map((to, i) => to - pace_length[i]!));
  const total = steps.reduce((sum, step) => sum + step, 0);
  if (total === 0) return [...t];
  let covered = 0;
  const u = [0, ...steps.map((step) => (covered += step + LEAST * total))];
  return u.map((x) => x / covered);
}

function between(knots: readonly number[], weights: Table, t: number): number[] {
  const { piece, share } = pieceAt(knots, t);
  const to = weights[piece + 1]!;
  return weights[piece]!.map((from, i) => (1 - share) * from + share * to[i]!);
}

function lookUp(xs: readonly number[], ys: readonly number[], x: number): number {
  const { piece, share } = pieceAt(xs, x);
  return (1 - share) * ys[piece]! + share * ys[piece + 1]!;
}

/** The inner knots at which the set of materials that carry weight changes, in any channel. */
function crossings(knots: readonly number[], weights: WeightTable): number[] {
  const piece = (k: number) =>
    CHANNELS.map((channel) => {
      const to = weights[channel][k + 1]!;
      return weights[channel][k]!.map((from, i) => (from > 0 || to[i]! > 0 ? "1" : "0")).join("");
    }).join();
  return knots.slice(1, -1).filter((_, k) => piece(k) !== piece(k + 1));
}
