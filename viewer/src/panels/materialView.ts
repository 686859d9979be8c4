// The material: a live picture of the exact mixed table.

import { el, iconButton, onResize, segments } from "../dom";
import type { Context } from "../main";
import { toEnvironment } from "../render/environment";
import { type Light, Painter } from "../render/painter";
import { HOME, type Shape } from "../render/stage";
import { EXPOSURES } from "../state";
import { nearestFirst } from "../wanted";

export function materialView(context: Context): HTMLElement {
  const { store } = context;
  const canvas = el("canvas", { id: "material", tabindex: 0, role: "img", "aria-label": "The material on an object; drag to turn it" });
  const note = el("span.note", { "aria-live": "polite" });
  const progress = el("i");
  const shapes = segments<Shape>("Object", [["sphere", "Sphere"], ["teapot", "Teapot"]], (shape) => store.set({ shape, orbit: HOME }));
  const lights = segments<Light>("Light", [["studio", "Studio"], ["points", "Three lights"]], (light) => store.set({ light }));
  store.watch(({ shape }) => shape, shapes.mark);
  store.watch(({ light }) => light, lights.mark);
  const panel = el(
    "section.panel.material.stage",
    { "aria-label": "Material" },
    {},
    canvas,
    el("div.overlay.top", {}, {}, el("h2", {}, {}, "Material"), note),
    el("div.overlay.bottom", {}, {}, shapes.element, lights.element, exposure(context), iconButton("home", "Turn back to the front", () => store.set({ orbit: HOME }))),
    el("div.bar", {}, {}, progress),
  );
  try {
    paint(context, panel, canvas, note, progress);
  } catch (error) {
    canvas.hidden = true;
    stillPictures(context, panel, error instanceof Error ? error.message : String(error));
  }
  return panel;
}

function paint(context: Context, panel: HTMLElement, canvas: HTMLCanvasElement, note: HTMLElement, progress: HTMLElement): void {
  const { store, tables } = context;
  const { library } = store.get();
  const painter = new Painter(canvas, tables, library.lights, toEnvironment(context.environment));
  const loop = new Loop(() => {
    const { recipe, exposure, route, t } = store.get();
    const names = recipe.map(({ name }) => name);
    const missing = names.filter((name) => tables.get(name) === undefined);
    // First all of the present recipe, then what the slider meets next, at a few samples: crossing into it shows at once.
    const rest = route ? nearestFirst(route, t) : [];
    const working = missing.length === 0 && painter.improve(names, loop.budget);
    const ahead = working || painter.improve(rest.slice(0, 12), Math.ceil(loop.budget / 2), 4);
    painter.show(recipe, 2 ** exposure);
    const samples = names.length ? painter.samples(names) : 0;
    note.textContent = missing.length
      ? `loading ${missing.length} of ${names.length} tables`
      : `${Math.min(samples, painter.targetSamples)} / ${painter.targetSamples} samples`;
    const share = missing.length ? 1 - missing.length / names.length : samples / painter.targetSamples;
    progress.style.transform = `scaleX(${share < 1 ? share : 0})`;
    panel.dataset.samples = String(missing.length ? 0 : samples);
    panel.dataset.ready = String(samples > 0 && missing.length === 0);
    return working || ahead;
  });
  onResize(panel, (width, height) => {
    const scale = Math.min(1, Math.sqrt(1.4e6 / (width * height)));
    painter.resize(Math.round(width * scale), Math.round(height * scale));
    const { shape, orbit, light } = store.get();
    painter.look(shape, orbit, light);
    loop.run();
  });
  store.watch(({ shape, orbit, light }) => [shape, orbit, light] as const, ([shape, orbit, light]) => {
    painter.look(shape, orbit, light);
    loop.run();
  });
  store.watch(({ recipe, exposure }) => [recipe, exposure], () => loop.run());
  store.watch(({ route, recipe }) => [route, recipe], () => {
    const { route, t, recipe } = store.get();
    if (route) tables.want([...new Set([...recipe.map(({ name }) => name), ...nearestFirst(route, t)])]);
  });
  tables.onChange = (problem) => {
    if (problem) store.set({ problem });
    document.dispatchEvent(new Event("tablechange"));
    loop.run();
  };
  orbitOnDrag(context, canvas);
}

/** Runs a frame while there is something to do, with as many passes as keep it fluent. */
class Loop {
  budget = 2;
  private running = false;
  private last = 0;

  constructor(private readonly frame: () => boolean) {}

  run(): void {
    if (this.running) return;
    this.running = true;
    this.last = 0;
    requestAnimationFrame(this.step);
  }

  private readonly step = (now: number) => {
    if (this.last > 0) {
      const elapsed = now - this.last;
      if (elapsed > 45) this.budget = Math.max(1, Math.floor(this.budget * 0.7));
      else if (elapsed < 25) this.budget = Math.min(48, this.budget + 1);
    }
    this.last = now;
    if (this.frame()) requestAnimationFrame(this.step);
    else this.running = false;
  };
}

function orbitOnDrag({ store }: Context, canvas: HTMLCanvasElement): void {
  let from: { x: number; y: number } | null = null;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    from = { x: event.clientX, y: event.clientY };
  });
  canvas.addEventListener("pointermove", (event) => {
    if (from === null) return;
    turn(-(event.clientX - from.x) * 0.008, (event.clientY - from.y) * 0.008);
    from = { x: event.clientX, y: event.clientY };
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { from = null; });
  const turn = (azimuth: number, elevation: number) => {
    const { orbit } = store.get();
    store.set({
      orbit: { ...orbit, azimuth: orbit.azimuth + azimuth, elevation: Math.min(Math.max(orbit.elevation + elevation, -1.4), 1.4) },
    });
  };
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const { orbit } = store.get();
    store.set({ orbit: { ...orbit, zoom: Math.min(Math.max(orbit.zoom * Math.exp(-event.deltaY * 0.001), 0.4), 4) } });
  }, { passive: false });
}

function exposure({ store }: Context): HTMLElement {
  const [min, max] = EXPOSURES;
  const input = el("input", { type: "range", min, max, step: 0.1, "aria-label": "Exposure in stops" }, {
    oninput: () => store.set({ exposure: Number(input.value) }),
    ondblclick: () => store.set({ exposure: 0 }),
  });
  const output = el("output");
  store.watch(({ exposure }) => exposure, (value) => {
    input.value = String(value);
    output.textContent = `${value > 0 ? "+" : value < 0 ? "−" : ""}${Math.abs(value).toFixed(1)} EV`;
  });
  return el("label.exposure", { title: "Exposure (double click: 0)" }, {}, input, output);
}

/** Without WebGL2: the small pictures, mixed on the processor. */
function stillPictures({ store, thumbnails }: Context, panel: HTMLElement, reason: string): void {
  const canvas = el("canvas.still", { width: thumbnails.size, height: thumbnails.size });
  panel.prepend(canvas, el("p.reason", { role: "status" }, {}, `A small picture stands in for the live one. ${reason}`));
  panel.querySelector(".overlay.bottom")?.remove();
  store.watch(({ recipe }) => recipe, (recipe) => {
    canvas.getContext("2d")!.putImageData(thumbnails.picture(recipe), 0, 0);
    panel.dataset.ready = "still";
  });
}
