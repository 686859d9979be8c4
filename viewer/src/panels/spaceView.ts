// The space: where each material is, what is between them, and the route.

import { el, onResize, segments, style } from "../dom";
import type { Context } from "../main";
import { CHANNELS, type Ingredient, recipeAt } from "../recipe";
import { Cloud } from "../render/cloud";

const ROUTE_POINTS = 160;
/** A pointer that moved less between down and up was a click, in CSS pixels. */
const STILL = 4;

export function spaceView(context: Context): HTMLElement {
  const { store, actions, thumbnails } = context;
  const names = store.get().library.materials.map(({ name }) => name);
  const indices = new Map(names.map((name, i) => [name, i]));
  const canvas = el("canvas.view", {
    id: "space-view",
    tabindex: 0,
    role: "img",
    "aria-label": "The materials as points; the search reaches them all",
  });
  const labels = el("div.labels", { "aria-hidden": "true" });
  const note = el("span.note");
  const channels = segments<string>(
    "Channel",
    CHANNELS.map((channel) => [channel, channel.toUpperCase()] as const),
    (channel) => {
      shown = channel;
      embed();
    },
  );
  const panel = el(
    "section.panel.space",
    { "aria-label": "Space" },
    {},
    canvas,
    labels,
    el("div.overlay.top", {}, {}, el("h2", {}, {}, "Space"), channels.element),
    el("div.overlay.bottom", {}, {}, note),
  );
  let shown = "r";
  let cloud: Cloud;
  try {
    cloud = new Cloud(canvas, names, thumbnails, () => draw());
  } catch {
    canvas.hidden = true;
    panel.append(
      el("p.reason", { role: "status" }, {}, "This view needs WebGL2. The search finds every material."),
    );
    return panel;
  }

  const embedding = () => {
    const embeddings = store.get().view?.embeddings ?? [];
    return embeddings.find(({ channel }) => channel === shown) ?? embeddings[0];
  };
  const weightsOf = (recipe: readonly Ingredient[]) => {
    const channel = CHANNELS.indexOf(embedding()?.channel as "r");
    return recipe.map(
      ({ name, weight: [r, g, b] }) =>
        [indices.get(name)!, channel < 0 ? (r + g + b) / 3 : [r, g, b][channel]!] as const,
    );
  };
  const embed = () => {
    const current = embedding();
    if (current === undefined) return;
    const single = store.get().view!.embeddings.length === 1;
    channels.element.hidden = single;
    channels.mark(current.channel);
    note.textContent = `${current.axes.join(", ")}, on quantile scales`;
    cloud.embed(current);
    traceRoute();
    place();
  };
  const traceRoute = () => {
    const { route } = store.get();
    if (route === null || cloud.display === null) return;
    const display = cloud.display;
    const ts = [
      ...new Set([...route.knots, ...Array.from({ length: ROUTE_POINTS + 1 }, (_, i) => i / ROUTE_POINTS)]),
    ].sort((a, b) => a - b);
    cloud.setRoute(ts.map((t) => display.mix(weightsOf(recipeAt(route, t)))));
    draw();
  };
  const place = () => {
    if (cloud.display === null) return;
    const corners = weightsOf(store.get().recipe).filter(([, weight]) => weight > 0);
    cloud.setSimplex(corners.map(([i]) => cloud.display!.points[i]!));
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
    cloud.setColours(style("--line"), style("--text"), style("--accent"), style("--panel"));
    draw();
  };

  let scheduled = false;
  const draw = () => {
    if (scheduled) return;
    scheduled = true;
    requestAnimationFrame(() => {
      scheduled = false;
      cloud.draw();
      placeLabels();
    });
  };
  const here = el("div.here");
  const placeLabels = () => {
    const { stops, hovered, recipe } = store.get();
    if (cloud.display === null) return;
    const shownNames = [...new Set([...(hovered ? [hovered] : []), ...stops])];
    const items = shownNames.map((name) => {
      const point = cloud.display!.points[indices.get(name)!]!;
      const { x, y } = cloud.project(point);
      const label = el(name === hovered ? "div.label.hovered" : "div.label", {}, {}, name);
      const gap = cloud.radius(point) * 1.5 + 5;
      const aside = x > canvas.clientWidth * 0.62 ? `calc(-100% - ${gap}px)` : `${gap}px`;
      label.style.transform = `translate(${x}px, ${y}px) translate(${aside}, -50%)`;
      return label;
    });
    if (recipe.length) {
      const { x, y } = cloud.project(cloud.display.mix(weightsOf(recipe)));
      here.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
      labels.replaceChildren(here, ...items);
    } else labels.replaceChildren(...items);
  };

  listenToPointer(canvas, {
    hover: (x, y) => {
      const i = cloud.pick(x, y);
      canvas.style.cursor = i === null ? "" : "pointer";
      store.set({ hovered: i === null ? null : names[i]! });
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
  document.addEventListener("themechange", paint);
  paint();
  store.watch(({ view }) => view, embed);
  store.watch(({ route }) => route, traceRoute);
  store.watch(({ recipe }) => recipe, place);
  store.watch(({ stops, hovered, found }) => [stops, hovered, found], dress);
  return panel;
}

interface Pointer {
  readonly hover: (x: number, y: number) => void;
  readonly leave: () => void;
  readonly click: (x: number, y: number) => void;
}

function listenToPointer(canvas: HTMLCanvasElement, { hover, leave, click }: Pointer): void {
  let down: { x: number; y: number } | null = null;
  canvas.addEventListener("pointermove", ({ offsetX, offsetY, buttons }) => {
    if (buttons === 0) hover(offsetX, offsetY);
  });
  canvas.addEventListener("pointerleave", leave);
  canvas.addEventListener("pointerdown", ({ offsetX, offsetY, button }) => {
    down = button === 0 ? { x: offsetX, y: offsetY } : null;
  });
  canvas.addEventListener("pointerup", ({ offsetX, offsetY }) => {
    if (down && Math.hypot(offsetX - down.x, offsetY - down.y) < STILL) click(offsetX, offsetY);
    down = null;
  });
}
