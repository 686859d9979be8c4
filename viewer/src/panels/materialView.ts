// The material: a live picture of the exact mixed table.

import type { Context } from "../context";
import { el, iconButton, onResize } from "../dom";
import { type Environment, toEnvironment } from "../render/environment";
import { LIGHTS, type Light, loadPicture } from "../render/environments";
import { Loop } from "../render/loop";
import { Painter } from "../render/painter";
import { HOME } from "../render/stage";
import { EXPOSURES } from "../state";
import { nearestFirst } from "../wanted";
import { openDropped, shapeChoice } from "./objects";
import { orbitOnDrag } from "./orbit";
import { splitHandle } from "./split";

export function materialView(context: Context): HTMLElement {
  const { store } = context;
  const canvas = el("canvas.view.live", {
    tabindex: 0,
    role: "img",
    "aria-label": "The material on an object; drag it, or press Alt and an arrow, to turn it",
  });
  const note = el("span.note");
  const progress = el("i");
  const home = iconButton("home", "Turn back to the front", () => store.set({ orbit: HOME }));
  store.watch(
    ({ orbit }) => orbit,
    (orbit) => {
      home.hidden = orbit === HOME;
    },
  );
  const panel = el(
    "section.panel.material.stage",
    { "aria-label": "Material" },
    {},
    canvas,
    el("div.overlay.top", {}, {}, el("h2", {}, {}, "Material"), el("div.group", {}, {}, note, home)),
    el(
      "div.overlay.bottom",
      {},
      {},
      shapeChoice(context),
      el("div.group", {}, {}, lightChoice(context), exposure(context)),
    ),
    splitHandle(context),
    el("div.bar", {}, {}, progress),
  );
  openDropped(context, panel);
  try {
    paint(context, panel, canvas, note, progress);
  } catch (error) {
    canvas.hidden = true;
    stillPictures(context, panel, error instanceof Error ? error.message : String(error));
  }
  return panel;
}

function paint(
  context: Context,
  panel: HTMLElement,
  canvas: HTMLCanvasElement,
  note: HTMLElement,
  progress: HTMLElement,
): void {
  const { store, tables, signal } = context;
  const { library } = store.get();
  const painter = new Painter(canvas, tables, library.lights);
  signal.addEventListener("abort", () => painter.dispose());
  // A slow card, or none, draws fewer pixels while something moves, and all of them when nothing does.
  let quality = 1;
  let refined = true;
  let idle = 0;
  /** By what makes a pass slow: begun, and done. */
  const prepared = new Map<string, boolean>();
  const hold = el("canvas.view.hold", { "aria-hidden": "true", hidden: true });
  canvas.after(hold);
  const fitSize = () => {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [panel.clientWidth * ratio, panel.clientHeight * ratio];
    const scale = (refined ? 1 : quality) * Math.min(1, Math.sqrt(MOST_PIXELS / (width * height)));
    painter.resize(Math.round(width * scale), Math.round(height * scale));
    look();
  };
  const environments = new Map<Light, Environment | null>([
    ["studio", toEnvironment(context.environment)],
    ["points", null],
  ]);
  /** In the chosen light; while its picture loads, in the one before. */
  const look = () => {
    const { shape, mesh, orbit, light } = store.get();
    const environment = environments.get(light);
    if (environment !== undefined) shownLight = environment;
    else if (light !== "studio" && light !== "points" && !loading.has(light)) {
      loading.add(light);
      loadPicture(light).then(
        (block) => {
          environments.set(light, toEnvironment(block));
          loop.run();
          if (store.get().light === light) look();
        },
        (error: Error) =>
          store.set({ problem: `The environment ${light} could not be loaded: ${error.message}` }),
      );
    }
    painter.look(shape, orbit, mesh?.geometry ?? null, shownLight);
  };
  const loading = new Set<Light>();
  let shownLight: Environment | null = environments.get("studio") ?? null;
  /** What a pass draws: an object with shadows takes longer than a sphere. */
  const setting = () => {
    const { shape, mesh } = store.get();
    return [painter.underPoints, shape, shape === "mesh" && mesh?.name].join();
  };
  /** Shaders, and how large a picture this card can draw while something moves: before the tables come. */
  const prepare = async () => {
    const now = setting();
    if (prepared.has(now)) return;
    prepared.set(now, false);
    await painter.warmUp();
    // Had it changed meanwhile, its own turn comes.
    if (signal.aborted || setting() !== now) {
      prepared.delete(now);
      return;
    }
    let milliseconds = painter.measure();
    // Much else begins now: a slow pass is given a second chance.
    if (milliseconds > PATIENCE) milliseconds = Math.min(milliseconds, painter.measure());
    prepared.set(now, true);
    const present = refined ? 1 : quality;
    const fitting = Math.max(LEAST_QUALITY, present * Math.min(1, Math.sqrt(PATIENCE / milliseconds)));
    loop.passMilliseconds = milliseconds * (fitting / present) ** 2;
    loop.goOn();
    if (fitting === present) return;
    quality = fitting;
    refined = false;
    fitSize();
  };
  const refine = () => {
    keep();
    refined = true;
    loop.passMilliseconds /= quality ** 2;
    fitSize();
    loop.goOn();
  };
  const coarsen = () => {
    window.clearTimeout(idle);
    if (!refined || quality === 1) return;
    keep();
    refined = false;
    loop.passMilliseconds *= quality ** 2;
    fitSize();
  };
  /** The picture as it is stays on top until the new one has come. */
  const keep = () => {
    hold.width = canvas.width;
    hold.height = canvas.height;
    hold.getContext("2d")!.drawImage(canvas, 0, 0);
    hold.hidden = false;
  };
  const loop = new Loop(() => {
    if (!prepared.get(setting())) {
      if (painter.hasSize) void prepare();
      return false;
    }
    const { recipe, otherRecipe, split, exposure } = store.get();
    const names = recipe.length
      ? [...new Set([...recipe, ...otherRecipe].map(({ name }) => name))]
      : stopsBesideT();
    const missing = names.filter((name) => tables.get(name) === undefined);
    const budget = loop.budget();
    // What has no picture at all gets one in any case, and is shown before it gets better.
    const first = painter.improve(names, Math.max(1, Math.floor(AT_ONCE / loop.passMilliseconds)), 1) > 0;
    // A small picture need not be finished: the large one starts over.
    const target = refined || quality === 1 ? painter.targetSamples : SAMPLES_TO_SHOW;
    const working = first || (recipe.length > 0 && painter.improve(names, budget, target) === budget);
    // Then what the slider meets next, at a few samples: crossing into it shows at once.
    const half = Math.ceil(budget / 2);
    const ahead =
      recipe.length > 0 &&
      !working &&
      painter.improve(comingUp().slice(0, N_AHEAD), half, SAMPLES_AHEAD) === half;
    painter.show(recipe, otherRecipe, split, 2 ** exposure);
    const samples = recipe.length && !missing.length ? painter.samples(names) : 0;
    note.textContent = missing.length
      ? `loading ${names.length === 1 ? "the table" : `${names.length} tables`}, ${Math.round(100 * tables.share(names))} %`
      : `${samples} / ${painter.targetSamples} samples`;
    const share = missing.length ? tables.share(names) : samples / painter.targetSamples;
    progress.style.transform = `scaleX(${share < 1 ? share : 0})`;
    if (samples >= (refined && quality < 1 ? Math.min(SAMPLES_TO_SHOW, painter.targetSamples) : 1))
      hold.hidden = true;
    window.clearTimeout(idle);
    if (!working && !ahead && samples > 0 && !refined) idle = window.setTimeout(refine, 800);
    panel.dataset.samples = String(samples);
    panel.dataset.ready = String(samples > 0);
    panel.dataset.settled = String(samples >= painter.targetSamples && (refined || quality === 1));
    return working || ahead;
  });
  const comingUp = () => {
    const { route, otherRoute, t } = store.get();
    const [own, other] = [route, otherRoute].map((r) => (r ? nearestFirst(r, t) : []));
    return [...new Set(own!.flatMap((name, i) => [name, other![i] ?? name]).concat(other!))];
  };
  /** A good guess before the route has come. */
  const stopsBesideT = () => {
    const { stops, t } = store.get();
    const leg = Math.min(Math.floor(t * (stops.length - 1)), stops.length - 2);
    return stops.slice(leg, leg + 2);
  };
  onResize(panel, () => {
    fitSize();
    loop.run();
  });
  store.watch(
    ({ shape, mesh, orbit, light }) => [shape, mesh, orbit, light],
    () => {
      coarsen();
      look();
      loop.run();
    },
  );
  store.watch(
    ({ recipe, otherRecipe, split, exposure }) => [recipe, otherRecipe, split, exposure],
    () => loop.run(),
  );
  store.watch(
    ({ recipe, otherRecipe }) => [recipe, otherRecipe] as const,
    ([recipe, otherRecipe]) => {
      const needed = [...new Set([...recipe, ...otherRecipe].map(({ name }) => name))];
      tables.want(needed, needed.length ? comingUp() : stopsBesideT());
    },
  );
  tables.onProgress = () => loop.goOn();
  tables.onChange = (problem) => {
    if (problem) store.set({ problem });
    store.set({ arrived: store.get().arrived + 1 });
    loop.goOn();
  };
  // All pictures went with the context, and begin again.
  canvas.addEventListener("webglcontextrestored", () => {
    look();
    loop.run();
  });
  orbitOnDrag(context, canvas);
}

const N_AHEAD = 12;
const SAMPLES_AHEAD = 4;
/** With so many, a picture of all pixels is less noisy than what it replaces. */
const SAMPLES_TO_SHOW = 48;
const MOST_PIXELS = 1.4e6;
/** Milliseconds that a pass over one material may take before the picture is made smaller. */
const PATIENCE = 40;
/** Not smaller than this share of the full width, however slow. */
const LEAST_QUALITY = 0.4;
/** Milliseconds in a frame that first samples may take, of as many materials as have none. */
const AT_ONCE = 100;

const TITLES: Partial<Record<Light, string>> = { points: "three lights" };

function lightChoice({ store }: Context): HTMLElement {
  const select = el(
    "select.field",
    { name: "light", "aria-label": "Light" },
    { onchange: () => store.set({ light: select.value as Light }) },
    ...LIGHTS.map((light) => el("option", { value: light }, {}, TITLES[light] ?? light)),
  );
  store.watch(
    ({ light }) => light,
    (light) => {
      select.value = light;
    },
  );
  return select;
}

function exposure({ store }: Context): HTMLElement {
  const [min, max] = EXPOSURES;
  const input = el(
    "input",
    { type: "range", min, max, step: 0.1, "aria-label": "Exposure in stops" },
    {
      oninput: () => store.set({ exposure: Number(input.value) }),
      ondblclick: () => store.set({ exposure: 0 }),
    },
  );
  const output = el("output");
  store.watch(
    ({ exposure }) => exposure,
    (value) => {
      input.value = String(value);
      output.textContent = `${value > 0 ? "+" : value < 0 ? "−" : ""}${Math.abs(value).toFixed(1)} EV`;
    },
  );
  return el("label.exposure", { title: "Exposure (double click: 0)" }, {}, input, output);
}

/** Without WebGL2: the small pictures, mixed on the processor. */
function stillPictures({ store, tables, thumbnails }: Context, panel: HTMLElement, reason: string): void {
  const canvas = el("canvas.view.still", { width: thumbnails.size, height: thumbnails.size });
  panel.prepend(
    canvas,
    el("p.reason", { role: "status" }, {}, `A small picture stands in for the live one. ${reason}`),
  );
  for (const part of panel.querySelectorAll(".overlay.bottom, .split")) part.remove();
  tables.onChange = (problem) => {
    store.set({ arrived: store.get().arrived + 1, ...(problem !== null && { problem }) });
  };
  store.watch(
    ({ recipe }) => recipe,
    (recipe) => {
      if (recipe.length === 0) return;
      // Of the other panels, the BRDF's draws from them.
      tables.want(recipe.map(({ name }) => name));
      canvas.getContext("2d")!.putImageData(thumbnails.picture(recipe), 0, 0);
      panel.dataset.ready = "still";
    },
  );
}
