// Films: the pictures of a route, or of an object that turns, one after another, as a video or as a zip of frames.

import type { Block } from "./api/client";
import { type Mixing, picturesMix } from "./blend";
import type { Context } from "./context";
import { type Ingredient, namesIn, only, toDocument } from "./recipe";
import type { Reel } from "./reel";
import { Photographer } from "./render/photograph";
import { mixedName, Tables } from "./render/tables";
import { recipeAt } from "./route";
import { turned, type View } from "./scene";
import { mixingOf } from "./shown";
import type { State } from "./state";

export const MOTIONS = ["route", "there and back", "turntable"] as const;
export type Motion = (typeof MOTIONS)[number];

export interface Film {
  readonly motion: Motion;
  /** Pixels along each side. */
  readonly size: number;
  readonly seconds: number;
  /** Samples of each frame; undefined: as many as of a picture. */
  readonly enough: number | undefined;
}

/** Frames in a second. */
export const RATE = 25;

export function frameCount({ seconds }: Film): number {
  return Math.max(2, Math.round(RATE * seconds));
}

/** What one of `n` frames shows. Those that turn, or come back, go on with the first after the last. */
export interface Frame {
  readonly view: View;
  readonly recipe: readonly Ingredient[];
  readonly mixing: Mixing;
}

export function frameAt(state: State, motion: Motion, i: number, n: number): Frame {
  if (motion === "turntable") {
    const orbit = turned(state.orbit, (2 * Math.PI * i) / n, 0);
    return { view: { ...state, orbit }, recipe: state.recipe, mixing: mixingOf(state) };
  }
  const { route } = state;
  if (route === null) throw new Error("there is no route yet.");
  const t = motion === "route" ? i / (n - 1) : 1 - Math.abs(1 - (2 * i) / n);
  return { view: state, recipe: recipeAt(route, t), mixing: route };
}

/** Draw all frames of a film onto a reel; `tell` hears how many are done, and `stopped` ends it. */
export async function shoot(
  { client, store, lights, tables: { grid } }: Context,
  film: Film,
  reel: Reel,
  {
    tell,
    stopped,
    finish,
  }: {
    readonly tell: (done: number, of: number) => void;
    readonly stopped: AbortSignal;
    /** What is done to each picture. */
    readonly finish: (picture: OffscreenCanvas) => void;
  },
): Promise<void> {
  const state = store.get();
  const environment = lights.get(state.light);
  if (environment === undefined) throw new Error("its light has not come yet.");
  const n = frameCount(film);
  const frames = Array.from({ length: n }, (_, i) => frameAt(state, film.motion, i, n));
  const names = namesIn(...frames.filter(({ mixing }) => picturesMix(mixing)).map(({ recipe }) => recipe));
  const tables = new Tables(client, grid);
  const camera = new Photographer(tables, state.library.lights, film.size, names.length);
  const look = { other: [], split: 1, exposure: 2 ** state.exposure, tone: state.tone, environment };
  try {
    await arrived(tables, names, stopped);
    for (const [i, { view, recipe, mixing }] of frames.entries()) {
      tell(i, n);
      const drawn = picturesMix(mixing) ? recipe : only(await mixed(i, recipe, mixing));
      const picture = await camera.take({
        ...look,
        view,
        recipe: drawn,
        ...(film.enough && { enough: film.enough }),
      });
      stopped.throwIfAborted();
      finish(picture);
      await reel.add(picture, i / RATE, 1 / RATE);
    }
  } finally {
    camera.dispose();
    tables.want([]);
  }

  /** The table of a mix, of its own for each recipe. */
  async function mixed(i: number, recipe: readonly Ingredient[], mixing: Mixing): Promise<string> {
    const isSame = i > 0 && frames[i - 1]!.recipe === recipe;
    const name = mixedName(`film ${isSame ? 0 : i}`);
    if (tables.get(name) === undefined) {
      const document = toDocument(state.library.name, recipe, mixing);
      const { halfs, scale }: Block = await client.mixed(document, false, stopped);
      tables.put({ name, grid, halfs, scale });
    }
    return name;
  }
}

/** Until all these tables have come. */
function arrived(tables: Tables, names: readonly string[], stopped: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const look = () => tables.share(names) === 1 && resolve();
    tables.onChange = (_, problem) => (problem === null ? look() : reject(new Error(problem)));
    stopped.addEventListener("abort", () => reject(stopped.reason));
    tables.want(names);
    if (names.length === 0) resolve();
  });
}
