// What is drawn of the space: the materials on the chosen map, what is between them, the route, and the present material.

import type { Vector3 } from "three";
import type { EmbeddingView } from "../../api/schema";
import { bodyScale, LINEAR } from "../../blend";
import type { Context } from "../../context";
import { coordinatesIn } from "../../coordinates";
import { onResize, segments, style } from "../../dom";
import { clamp } from "../../numbers";
import { paced } from "../../paced";
import { materialAsGhost } from "../../pointing";
import { weightIn } from "../../recipe";
import { Appearance } from "../../render/appearance";
import type { Cloud } from "../../render/cloud";
import { CoordinateMap, type SpaceMap } from "../../render/maps";
import { recipeAt } from "../../route";
import { isAway, mixingOf } from "../../shown";
import { GRID, NUMBERS, type State } from "../../state";
import { tintsOf } from "../../tint";
import { turnOnKeys } from "../material/orbit";
import { sayWhenLost } from "../notices";
import { FreePoint } from "./free";
import { inWords, Labels } from "./labels";
import { byNumbers, pointBy } from "./measured";
import { listenToPointer, type Pointer } from "./pointer";

const APPEARANCE = "Looks";
/** Milliseconds between drawings: what moves is the material, and this stands beside it. */
const BESIDE = 60;
/** Values that are written along each axis: at its ends, for in the middle all axes meet. */
const TICKS = 2;
/** Pieces of the route's line; and where each point takes a picture to be made. */
const ROUTE_POINTS = 160;
const ROUTE_PICTURES = 40;

export class SpacePicture {
  readonly labels: Labels;
  private readonly appearance: Appearance;
  private axes: ReturnType<CoordinateMap["axes"]> = [];
  /** What the chosen map shows; undefined for that of looks. */
  private embedding: EmbeddingView | undefined;
  private readonly free: FreePoint;
  private trace: Trace = { ts: [], points: [] };
  /** Where a person pointed, when no mix is there. */
  private asked: Vector3 | null = null;
  private readonly draw = paced(() => this.drawNow(), BESIDE);

  constructor(
    private readonly context: Context,
    private readonly cloud: Cloud,
    private readonly canvas: HTMLCanvasElement,
    private readonly beside: { readonly maps: HTMLElement; readonly note: HTMLElement },
  ) {
    const { store, signal, names, thumbnails } = context;
    this.appearance = new Appearance(names, thumbnails);
    this.free = new FreePoint(context, cloud);
    this.labels = new Labels((x, y) => this.free.drag(x, y));
    signal.addEventListener("abort", () => cloud.dispose());
    cloud.controls.addEventListener("change", this.draw);
    sayWhenLost(context, "space", canvas, this.draw);
    turnOnKeys(canvas, (azimuth, elevation) => cloud.turn(azimuth, elevation));
    listenToPointer(canvas, this.pointer());
    onResize(canvas, (width, height, ratio) => {
      cloud.resize(width, height, ratio);
      // At once, so that the panel is not empty for a frame.
      this.drawNow();
    });
    store.watch(["scheme"], () => this.paint());
    store.watch(["view"], () => this.offer());
    store.watch(["route"], () => this.traceRoute());
    store.watch(["recipe", "atPoint"], () => this.putRecipe());
    store.watch(["stops", "hovered", "matches"], (state) => this.dress(state));
    store.watch(["attributes", "tint"], (state) => this.colour(state));
    store.watch(["attributes", "axes"], () => this.chosen === NUMBERS && this.arrange());
    store.watch(["numbers"], () => this.chosen === NUMBERS && this.putRecipe());
  }

  private choose(): EmbeddingView | undefined {
    const { view, map, attributes, axes } = this.context.store.get();
    if (map === NUMBERS) return attributes ? byNumbers(attributes, axes) : undefined;
    return view?.embeddings.find(({ name }) => name === map);
  }

  /** The name of the map that is shown. */
  private get chosen(): string {
    const { view, map } = this.context.store.get();
    const names = [GRID, NUMBERS, ...(view?.embeddings ?? []).map(({ name }) => name)];
    return names.includes(map) ? map : APPEARANCE;
  }

  /** The maps that the space has. */
  private offer(): void {
    const embeddings = this.context.store.get().view?.embeddings ?? [];
    const options = [APPEARANCE, ...embeddings.map(({ name }) => name), NUMBERS, GRID];
    const { element, mark } = segments(
      "Map",
      options.map((name) => [name]),
      (map) => {
        this.context.store.set({ map });
        mark(map);
        this.arrange();
      },
    );
    mark(this.chosen);
    this.beside.maps.replaceChildren(element);
    this.arrange();
  }

  private arrange(): void {
    this.embedding = this.choose();
    const { embedding } = this;
    const map = embedding ? new CoordinateMap(embedding, this.context.names) : this.appearance;
    this.cloud.arrange(map, embedding?.edges ?? []);
    this.axes = map instanceof CoordinateMap ? map.axes(TICKS) : [];
    this.cloud.setAxes(
      this.axes.flatMap(({ ticks }) => ticks.slice(1).map(({ at }, i) => [ticks[i]!.at, at] as const)),
    );
    this.trace = { ts: [], points: [] };
    this.traceRoute();
    this.putRecipe();
    this.describe();
  }

  private describe(): void {
    const state = this.context.store.get();
    const { atPoint } = state;
    const axes = this.embedding?.axes.slice(0, 3);
    // The axes are written where they are chosen.
    this.beside.note.hidden = [GRID, NUMBERS].includes(this.chosen);
    if (this.embedding && bodyScale(mixingOf(state)))
      this.beside.note.textContent = "its body is scaled: this space has no place for it";
    else if (atPoint !== null && !atPoint.inside)
      this.beside.note.textContent = "no mix is at the ring: the dot is one nearby";
    else
      this.beside.note.textContent = axes
        ? `${axes.map(inWords).join(", ")}; spread evenly along each`
        : "close together: look alike";
  }

  private traceRoute(): void {
    const { route } = this.context.store.get();
    const { map } = this.cloud;
    if (route === null || map === null) return;
    if (this.chosen === NUMBERS) {
      // What lies between is not known until it is shown.
      this.cloud.setRoute([], []);
      this.putRecipe();
      return;
    }
    const isOfPictures = map === this.appearance && route.blend !== LINEAR;
    const n = isOfPictures ? ROUTE_PICTURES : ROUTE_POINTS;
    const even = Array.from({ length: n + 1 }, (_, i) => i / n);
    const ts = isOfPictures ? even : [...new Set([...route.knots, ...even])].sort((a, b) => a - b);
    const again = () => {
      if (this.cloud.map === map && this.context.store.get().route === route) this.traceRoute();
    };
    const points = ts.map((t) => map.pointOf(recipeAt(route, t), route, again));
    this.trace = { ts, points };
    const crossings = route.crossings.map((t) => along(this.trace, t));
    this.cloud.setRoute(points, crossings);
    this.putRecipe();
  }

  /** The present material, and lines: between its ingredients in a space, from it to them among looks. */
  private putRecipe(): void {
    const { map } = this.cloud;
    const { recipe } = this.context.store.get();
    if (map === null || recipe.length === 0) return;
    const { embedding } = this;
    const corners = recipe
      .filter((ingredient) => embedding === undefined || weightIn(ingredient, embedding.channel) > 0)
      .map(({ name }) => map.points[this.context.names.indexOf(name)]!);
    const here = this.present(map);
    this.free.here = here;
    this.asked = this.outside();
    const isOfSpace = embedding !== undefined && this.chosen !== NUMBERS;
    this.cloud.setIngredients(
      isOfSpace ? pairs(corners) : corners.flatMap((corner) => (here ? [[here, corner]] : [])),
    );
    this.describe();
    this.draw();
  }

  /** Where the present material is: on the line of the route, where it is on the route. */
  private present(map: SpaceMap): Vector3 | null {
    const state = this.context.store.get();
    if (map instanceof CoordinateMap && this.chosen === NUMBERS) {
      const point = pointBy(state.numbers?.attributes ?? {}, state.axes);
      return point && map.pointAt(point);
    }
    const isOnLine = map === this.appearance && this.trace.ts.length > 0 && !isAway(state);
    if (isOnLine) return along(this.trace, state.t);
    // The coordinates of a scaled body are not those of its materials, mixed.
    if (map instanceof CoordinateMap && bodyScale(mixingOf(state))) return null;
    return map.pointOf(state.recipe, mixingOf(state), () => this.putRecipe());
  }

  /** Where a person pointed, on this map; null when a mix is there. */
  private outside(): Vector3 | null {
    const { view, point, atPoint } = this.context.store.get();
    const { map } = this.cloud;
    if (!view || !point || !atPoint || atPoint.inside || !(map instanceof CoordinateMap)) return null;
    return map.pointAt(coordinatesIn(view, point, this.chosen));
  }

  private dress({ stops, hovered, matches }: State): void {
    const [stopped, hits] = [new Set(stops), matches && new Set(matches)];
    this.cloud.setLooks(
      this.context.names.map((name) => ({
        ring: name === hovered ? "hovered" : stopped.has(name) ? "stop" : "none",
        dim: hits !== null && !hits.has(name),
      })),
    );
    this.draw();
  }

  private colour({ attributes, tint }: State): void {
    const shown = attributes?.find(({ name }) => name === tint);
    this.cloud.setTints(shown ? tintsOf(shown) : null);
    this.draw();
  }

  private paint(): void {
    const [text, accent, panel] = ["--text", "--accent", "--panel"].map((name) =>
      style(this.context.root, name),
    );
    this.cloud.setColours(text!, accent!, panel!);
    this.draw();
  }

  private drawNow(): void {
    this.cloud.draw();
    const { map } = this.cloud;
    if (map === null) return;
    const { stops, hovered } = this.context.store.get();
    const named = [...new Set([...(hovered ? [hovered] : []), ...stops])].map((name) => ({
      name,
      point: map.points[this.context.names.indexOf(name)]!,
      isHovered: name === hovered,
    }));
    const { cloud, asked } = this;
    const { here, isFree } = this.free;
    this.labels.draw(cloud, this.canvas.clientWidth, named, { here, asked, isFree });
    this.labels.drawTicks(cloud, this.axes);
  }

  private pointer(): Pointer {
    const { cloud, canvas } = this;
    const { store, actions, names } = this.context;
    return {
      hover: (x, y) => {
        const i = cloud.pick(x, y);
        canvas.style.cursor = this.free.isAt(x, y) ? "move" : i === null ? "" : "pointer";
        const name = i === null ? null : names[i]!;
        store.set({ hovered: name, pointed: name ? materialAsGhost(name) : this.free.under(x, y) });
      },
      grab: (x, y) => {
        cloud.controls.enabled = !this.free.isAt(x, y);
        return !cloud.controls.enabled;
      },
      drag: (x, y) => this.free.drag(x, y),
      release: () => {
        cloud.controls.enabled = true;
      },
      leave: () => store.set({ hovered: null, pointed: null }),
      click: (x, y) => {
        const i = cloud.pick(x, y);
        if (i !== null) actions.choose(names[i]!);
      },
    };
  }
}

/** Points of a line, by t. */
interface Trace {
  readonly ts: readonly number[];
  readonly points: readonly Vector3[];
}

function along({ ts, points }: Trace, t: number): Vector3 {
  const i = clamp(ts.findIndex((each) => each >= t) - 1, 0, ts.length - 2);
  const share = clamp((t - ts[i]!) / (ts[i + 1]! - ts[i]!), 0, 1);
  return points[i]!.clone().lerp(points[i + 1]!, share);
}

/** Each two of them. */
function pairs<T>(items: readonly T[]): (readonly [T, T])[] {
  return items.flatMap((a, i) => items.slice(i + 1).map((b) => [a, b] as const));
}
