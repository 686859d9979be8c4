// The space: where each material is, what is between them, and the route.

import type { Vector3 } from "three";

import type { Context } from "../../context";
import { coordinatesIn, pointOf, withCoordinates } from "../../coordinates";
import { el, onResize, segments, style } from "../../dom";
import { paced } from "../../paced";
import { materialAsGhost } from "../../pointing";
import { weightIn } from "../../recipe";
import { Appearance } from "../../render/appearance";
import { NoCardError } from "../../render/card";
import { Cloud } from "../../render/cloud";
import { CoordinateMap } from "../../render/maps";
import { recipeAt } from "../../route";
import { GRID, type State } from "../../state";
import { turnOnKeys } from "../material/orbit";
import { notices, sayWhenLost } from "../notices";
import { gridFilters, materialGrid } from "./grid";
import { inWords, Labels } from "./labels";
import { listenToPointer, type Pointer } from "./pointer";

const APPEARANCE = "Looks";
/** Milliseconds between drawings: what moves is the material, and this stands beside it. */
const BESIDE = 60;
/** Values that are written along each axis: at its ends, for in the middle all axes meet. */
const TICKS = 2;
const ROUTE_POINTS = 160;
/** How near the pointer has to be to take the present material, in CSS pixels. */
const MARKER = 11;

export function spacePanel(context: Context): HTMLElement {
  const canvas = el("canvas.view.cloud", {
    tabindex: 0,
    role: "img",
    "aria-label": "The materials as points; Alt and an arrow turn them, and the search reaches them all",
  });
  const maps = el("div.maps");
  const area = el("div.area", canvas);
  const note = el("span.note");
  const title = el("div.line.bar", el("h2", "Space"), maps);
  const filters = gridFilters(context);
  const foot = el("div.line.bar", note, filters);
  const panel = el(
    "section.panel.space",
    { "aria-label": "Space" },
    title,
    area,
    foot,
    notices(context, "space"),
  );
  let begun = false;
  // The materials are drawn as their pictures.
  context.store.watch(["pictured"], ({ pictured }) => {
    if (!pictured || begun) return;
    begun = true;
    try {
      const cloud = new Cloud(canvas, context.names, context.thumbnails);
      area.append(new SpacePicture(context, cloud, canvas, { maps, note }).labels.element);
    } catch (error) {
      if (!(error instanceof NoCardError)) throw error;
      context.actions.say(
        "space",
        "card",
        "The space itself needs WebGL2, which this browser does not have.",
      );
      context.store.set({ map: GRID });
    }
  });
  let grid: HTMLElement | undefined;
  context.store.watch(["map", "pictured"], ({ map, pictured }) => {
    const isGrid = map === GRID;
    if (isGrid && pictured && !grid) {
      grid = materialGrid(context);
      area.append(grid);
    }
    area.classList.toggle("side-by-side", isGrid);
    note.hidden = isGrid;
    filters.hidden = !isGrid;
  });
  return panel;
}

class SpacePicture {
  readonly labels: Labels;
  private readonly appearance: Appearance;
  private axes: ReturnType<CoordinateMap["axes"]> = [];
  /** Where the present material is. */
  private here: Vector3 | null = null;
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
    this.labels = new Labels((x, y) => this.drag(x, y));
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
  }

  /** What the chosen map shows; undefined for that of looks. */
  private get embedding() {
    const { view, map } = this.context.store.get();
    return view?.embeddings.find(({ name }) => name === map);
  }

  /** The name of the map that is shown. */
  private get chosen(): string {
    return this.context.store.get().map === GRID ? GRID : (this.embedding?.name ?? APPEARANCE);
  }

  /** The maps that the space has. */
  private offer(): void {
    const embeddings = this.context.store.get().view?.embeddings ?? [];
    const options = [APPEARANCE, ...embeddings.map(({ name }) => name), GRID];
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
    const { embedding } = this;
    const map = embedding ? new CoordinateMap(embedding, this.context.names) : this.appearance;
    this.cloud.arrange(map, embedding?.edges ?? []);
    this.axes = map instanceof CoordinateMap ? map.axes(TICKS) : [];
    this.cloud.setAxes(
      this.axes.flatMap(({ ticks }) => ticks.slice(1).map(({ at }, i) => [ticks[i]!.at, at] as const)),
    );
    this.traceRoute();
    this.putRecipe();
    this.describe();
  }

  private describe(): void {
    const { atPoint } = this.context.store.get();
    const axes = this.embedding?.axes.slice(0, 3);
    if (atPoint !== null && !atPoint.inside)
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
    const even = Array.from({ length: ROUTE_POINTS + 1 }, (_, i) => i / ROUTE_POINTS);
    const ts = [...new Set([...route.knots, ...even])].sort((a, b) => a - b);
    const points = (all: readonly number[]) => all.map((t) => map.pointOf(recipeAt(route, t)));
    this.cloud.setRoute(points(ts), points(route.crossings));
    this.draw();
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
    const here = map.pointOf(recipe);
    this.here = here;
    this.asked = this.outside();
    this.cloud.setIngredients(embedding ? pairs(corners) : corners.map((corner) => [here, corner]));
    this.describe();
    this.draw();
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
    const { cloud, here, asked } = this;
    this.labels.draw(cloud, this.canvas.clientWidth, named, { here, asked, isFree: this.isFree });
    this.labels.drawTicks(cloud, this.axes);
  }

  private pointer(): Pointer {
    const { cloud, canvas } = this;
    const { store, actions, names } = this.context;
    return {
      hover: (x, y) => {
        const i = cloud.pick(x, y);
        canvas.style.cursor = this.isAtMarker(x, y) ? "move" : i === null ? "" : "pointer";
        const name = i === null ? null : names[i]!;
        store.set({ hovered: name, pointed: name ? materialAsGhost(name) : this.placeAt(x, y) });
      },
      grab: (x, y) => {
        cloud.controls.enabled = !this.isAtMarker(x, y);
        return !cloud.controls.enabled;
      },
      drag: (x, y) => this.drag(x, y),
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

  /** Whether the pointer is at the present material, which can be dragged. */
  private isAtMarker(x: number, y: number): boolean {
    const { cloud, here } = this;
    if (here === null || !this.isFree) return false;
    const at = cloud.project(here);
    return Math.hypot(at.x - x, at.y - y) <= MARKER;
  }

  /** Whether the present material can leave the route on this map. */
  private get isFree(): boolean {
    return this.cloud.map instanceof CoordinateMap && !!this.context.store.get().view?.has_points;
  }

  private drag(x: number, y: number): void {
    const there = this.pointAt(x, y);
    if (there !== null) this.context.actions.goTo(there);
  }

  /** A point that is pointed at, where the present material could go. */
  private placeAt(x: number, y: number): State["pointed"] {
    const there = this.isFree && !this.isAtMarker(x, y) ? this.pointAt(x, y) : null;
    return there && { point: there };
  }

  /** The point of the space under the pointer, as far away as the present material; null where the map has none. */
  private pointAt(x: number, y: number): number[] | null {
    const { store, names } = this.context;
    const { view, recipe, point } = store.get();
    const { map } = this.cloud;
    if (!(map instanceof CoordinateMap) || view === null || this.here === null) return null;
    const coordinates = map.coordinatesAt(this.cloud.unproject(x, y, this.here));
    return withCoordinates(view, point ?? pointOf(view, names, recipe), this.chosen, coordinates);
  }
}

/** Each two of them. */
function pairs<T>(items: readonly T[]): (readonly [T, T])[] {
  return items.flatMap((a, i) => items.slice(i + 1).map((b) => [a, b] as const));
}
