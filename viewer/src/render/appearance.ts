// The materials by what they look like: those that look alike are close, whatever their scores.
//
// A material's small picture, averaged to blocks and coded by the cube root (about as CIELAB codes lightness), is a vector; the
// map is its first three principal components over the library. A mix is drawn where its own picture is, in its own blend, so a
// route that makes a detour through other colours is seen to make it.

import { Vector3 } from "three";

import type { Mixing } from "../blend";
import { dot } from "../numbers";
import { type Ingredient, only } from "../recipe";
import type { Thumbnails } from "../thumbnails";
import { components } from "./axes";
import type { SpaceMap } from "./maps";

const BLOCKS = 12;
const RADIUS = 1.42;

export class Appearance implements SpaceMap {
  readonly points: readonly Vector3[];
  private readonly mean: Float64Array;
  private readonly axes: readonly Float64Array[];
  private readonly scale: number;

  constructor(
    names: readonly string[],
    private readonly thumbnails: Thumbnails,
  ) {
    const vectors = names.map((name) => this.code(only(name)));
    this.mean = new Float64Array(vectors[0]?.length ?? 0);
    for (const vector of vectors)
      for (let i = 0; i < vector.length; i++) this.mean[i]! += vector[i]! / vectors.length;
    const centred = vectors.map((vector) => this.centred(vector));
    this.axes = components(centred, 3);
    const points = centred.map((vector) => this.project(vector));
    this.scale = RADIUS / Math.max(...points.map((p) => p.length()), 1e-9);
    this.points = points.map((p) => p.multiplyScalar(this.scale));
  }

  pointOf(recipe: readonly Ingredient[], mixing: Mixing, then: () => void): Vector3 {
    return this.project(this.centred(this.code(recipe, mixing, then))).multiplyScalar(this.scale);
  }

  private code(recipe: readonly Ingredient[], mixing?: Mixing, then?: () => void): Float64Array {
    return Float64Array.from(this.thumbnails.blocks(recipe, BLOCKS, mixing, then), Math.cbrt);
  }

  private centred(vector: Float64Array): Float64Array {
    return vector.map((x, i) => x - this.mean[i]!);
  }

  /** Second component to the right, third away, first up. */
  private project(vector: Float64Array): Vector3 {
    const [up, right, away] = this.axes.map((axis) => dot(axis, vector));
    return new Vector3(right, away, up);
  }
}
