// The space: where each material is, what is between them, and the route.

import type { Vector3 } from "three";
import type { Context } from "../context";
import { el, onResize, segments, style } from "../dom";
import { coordinatesIn, hasPlaces, pointOf, withCoordinates } from "../place";
import { recipeAt, weightIn } from "../recipe";
import { Appearance } from "../render/appearance";
import { Cloud } from "../render/cloud";
import { Scores } from "../render/display";
import { paced } from "../render/loop";
import { labelPlaces } from "./labels";
import { turnOnKeys } from "./orbit";
import { shelf } from "./shelf";

const APPEARANCE = "Looks";
/** Milliseconds between drawings: what moves is the material, and this stands beside it. */
const BESIDE = 60;
const ROUTE_POINTS = 160;
/** How near the pointer has to be to take the present material, in CSS pixels. */
const MARKER = 11;
/** A pointer that moved less between down and up was a click, in CSS pixels. */
const STILL = 4;

export function spaceView(context: Context): HTMLElement {
  const { root, store, actions, thumbnails, signal } = context;
  const names = store.get().library.materials.map(({ name }) => name);
  const indices = new Map(names.map((name, i) => [name, i]));
  const canvas = el("canvas.view.cloud", {
    tabindex: 0,
    role: "img",
    "aria-label": "The materials as points; Alt and an arrow turn them, and the search reaches them all",
  });
  const labels = el("div.labels", { "aria-hidden": "true" });
  const note = el("span.note");
  const maps = el("div.maps");
  const panel = el(
    "section.panel.space",
    { "aria-label": "Space" },
    {},
    canvas,
    labels,
    el("div.overlay.top", {}, {}, el("h2", {}, {}, "Space"), maps),
    el("div.overlay.bottom", {}, {}, note),
  );
  let shown = APPEARANCE;
  let cloud: Cloud;
  try {
    cloud = new Cloud(canvas, names, thumbnails, () => draw());
    signal.addEventListener("abort", () => cloud.dispose());
  } catch {
    canvas.hidden = true;
    panel.append(
      shelf(context),
      el(
        "p.reason",
        { role: "status" },
        {},
        "The space itself needs WebGL2, which this browser does not have.",
      ),
    );
    return panel;
  }

  const appearance = new Appearance(names, thumbnails);
  const embedding = () => store.get().view?.embeddings.find(({ name }) => name === shown);
  const offer = () => {
    const embeddings = store.get().view?.embeddings ?? [];
    const options = [APPEARANCE, ...embeddings.map(({ name }) => name)].map((name) => [name, name] as const);
    if (!options.some(([map]) => map === shown)) shown = APPEARANCE;
    const choice = segments("Map", options, (map) => {
      shown = map;
      choice.mark(map);
      arrange();
    });
    choice.mark(shown);
    maps.replaceChildren(choice.element);
    arrange();
  };
  const arrange = () => {
    const current = embedding();
    describe();
    cloud.arrange(current ? new Scores(current, names) : appearance, current?.edges ?? []);
    traceRoute();
    place();
  };
  const describe = () => {
    const current = embedding();
    const { place } = store.get();
    if (place !== null && !place.inside) note.textContent = "no mix is at the ring: the dot is the nearest";
    else
      note.textContent = current
        ? `${current.axes.join(", ")}; quantile scales`
        : "close together: look alike";
  };
  const traceRoute = () => {
    const { route } = store.get();
    const { placement } = cloud;
    if (route === null || placement === null) return;
    const even = Array.from({ length: ROUTE_POINTS + 1 }, (_, i) => i / ROUTE_POINTS);
    const ts = [...new Set([...route.knots, ...even])].sort((a, b) => a - b);
    const [line, crossings] = [ts, route.crossings].map((all) =>
      all.map((t) => placement.place(recipeAt(route, t))),
    );
    cloud.setRoute(line!, crossings!);
    draw();
  };
  const place = () => {
    const { placement } = cloud;
    const { recipe } = store.get();
    if (placement === null || recipe.length === 0) return;
    const current = embedding();
    const corners = recipe
      .filter((ingredient) => current === undefined || weightIn(ingredient, current.channel) > 0)
      .map(({ name }) => placement.points[indices.get(name)!]!);
    here3d = placement.place(recipe);
    // In a space the simplex; among looks, what the material is made of.
    const { view, point, place: found } = store.get();
    const outside = found !== null && !found.inside && cloud.placement instanceof Scores && current;
    asked3d =
      outside && view && point
        ? (cloud.placement as Scores).at(coordinatesIn(view, point, current.name))
        : null;
    describe();
    cloud.setIngredients(current ? pairs(corners) : corners.map((corner) => [here3d!, corner] as const));
    draw();
  };
  const dress = () => {
    const { stops, hovered, found } = store.get();
    const stopped = new Set(stops);
    const hits = found && new Set(found);
    cloud.setLooks(
      names.map((name) => ({
        ring: name === hovered ? "hovered" : stopped.has(name) ? "stop" : "none",
        dim: hits !== null && !hits.has(name),
      })),
    );
    draw();
  };
  const paint = () => {
    cloud.setColours(style(root, "--text"), style(root, "--accent"), style(root, "--panel"));
    draw();
  };

  const draw = paced(() => {
    cloud.draw();
    placeLabels();
  }, BESIDE);
  const here = el("div.here");
  let here3d: Vector3 | null = null;
  /** Where a person pointed, when no mix is there. */
  const asked = el("div.asked");
  let asked3d: Vector3 | null = null;
  const placeLabels = () => {
    const { stops, hovered } = store.get();
    if (cloud.placement === null) return;
    const shownNames = [...new Set([...(hovered ? [hovered] : []), ...stops])];
    const anchors = shownNames.map((name) => {
      const point = cloud.placement!.points[indices.get(name)!]!;
      return { ...cloud.project(point), gap: cloud.radius(point) * 1.5 + 5 };
    });
    const items = labelPlaces(anchors, canvas.clientWidth).map(({ x, y, side }, i) => {
      const name = shownNames[i]!;
      const label = el(name === hovered ? "div.label.hovered" : "div.label", {}, {}, name);
      label.style.transform = `translate(${x}px, ${y}px) translate(${side === "left" ? "-100%" : "0"}, -50%)`;
      return label;
    });
    const markers = [
      [here, here3d],
      [asked, asked3d],
    ] as const;
    const placed = markers.filter(([, point]) => point !== null);
    for (const [marker, point] of placed) {
      const { x, y } = cloud.project(point!);
      marker.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
    }
    labels.replaceChildren(...placed.map(([marker]) => marker), ...items);
  };

  const onMarker = (x: number, y: number) => {
    if (here3d === null || !(cloud.placement instanceof Scores) || !hasPlaces(store.get().view)) return false;
    const at = cloud.project(here3d);
    return Math.hypot(at.x - x, at.y - y) <= MARKER;
  };
  const drag = (x: number, y: number) => {
    const { view, recipe, point } = store.get();
    const current = embedding();
    if (!(cloud.placement instanceof Scores) || view === null || current === undefined || here3d === null)
      return;
    const coordinates = cloud.placement.coordinatesAt(cloud.unproject(x, y, here3d));
    actions.goTo(withCoordinates(view, point ?? pointOf(view, names, recipe), current.name, coordinates));
  };
  turnOnKeys(canvas, (azimuth, elevation) => cloud.turn(azimuth, elevation));
  canvas.addEventListener("webglcontextrestored", () => draw());
  listenToPointer(canvas, {
    hover: (x, y) => {
      const i = cloud.pick(x, y);
      canvas.style.cursor = onMarker(x, y) ? "move" : i === null ? "" : "pointer";
      store.set({ hovered: i === null ? null : names[i]! });
    },
    grab: (x, y) => {
      const grabbed = onMarker(x, y);
      cloud.controls.enabled = !grabbed;
      return grabbed;
    },
    drag,
    release: () => {
      cloud.controls.enabled = true;
    },
    leave: () => store.set({ hovered: null }),
    click: (x, y) => {
      const i = cloud.pick(x, y);
      if (i !== null) actions.choose(names[i]!);
    },
  });
  onResize(panel, (width, height, ratio) => {
    cloud.resize(width, height, ratio);
    // At once, so that the panel is not empty for a frame.
    cloud.draw();
    placeLabels();
  });
  store.watch(({ scheme }) => scheme, paint);
  store.watch(({ view }) => view, offer);
  store.watch(({ route }) => route, traceRoute);
  store.watch(({ recipe, place }) => [recipe, place], place);
  store.watch(({ stops, hovered, found }) => [stops, hovered, found], dress);
  return panel;
}

interface Pointer {
  readonly hover: (x: number, y: number) => void;
  readonly leave: () => void;
  readonly click: (x: number, y: number) => void;
  /** True when what is under the pointer is to be dragged. */
  readonly grab: (x: number, y: number) => boolean;
  readonly drag: (x: number, y: number) => void;
  readonly release: () => void;
}

function listenToPointer(
  canvas: HTMLCanvasElement,
  { hover, leave, click, grab, drag, release }: Pointer,
): void {
  let down: { x: number; y: number } | null = null;
  let dragging = false;
  canvas.addEventListener("pointermove", ({ offsetX, offsetY, buttons }) => {
    if (dragging) drag(offsetX, offsetY);
    else if (buttons === 0) hover(offsetX, offsetY);
  });
  canvas.addEventListener("pointerleave", leave);
  // Before the controls hear of it, so that they can be told to stay.
  canvas.addEventListener(
    "pointerdown",
    ({ offsetX, offsetY, button, pointerId }) => {
      down = button === 0 ? { x: offsetX, y: offsetY } : null;
      dragging = down !== null && grab(offsetX, offsetY);
      // Let go of beside the panel, it is let go of all the same.
      if (dragging) canvas.setPointerCapture(pointerId);
    },
    { capture: true },
  );
  canvas.addEventListener("pointerup", ({ offsetX, offsetY }) => {
    if (!dragging && down && Math.hypot(offsetX - down.x, offsetY - down.y) < STILL) click(offsetX, offsetY);
    end();
  });
  const end = () => {
    if (dragging) release();
    down = null;
    dragging = false;
  };
  canvas.addEventListener("pointercancel", end);
}

/** Each two of them. */
function pairs<T>(items: readonly T[]): (readonly [T, T])[] {
  return items.flatMap((a, i) => items.slice(i + 1).map((b) => [a, b] as const));
}
