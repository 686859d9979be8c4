// The material: a live picture of the exact mixed table.

import { isIsotropic } from "../../brdf/grid";
import type { Context } from "../../context";
import { dropdown, el, iconButton, popover } from "../../dom";
import { NoCardError } from "../../render/card";
import { EXPOSURES, HOME, LIGHTS, type Light, TONES, TURNS } from "../../scene";
import { notices } from "../notices";
import { filmButton } from "./film";
import { ghostTag } from "./ghost";
import { LivePicture, type Progress } from "./live";
import { shapeChoice } from "./objects";
import { orbitOnDrag } from "./orbit";
import { pictureButton } from "./picture";
import { splitHandle } from "./split";
import { stillPictures } from "./still";

export function materialPanel(context: Context): HTMLElement {
  const canvas = el("canvas.view.live", {
    tabindex: 0,
    role: "img",
    "aria-label": "The material on an object; drag it, or press Alt and an arrow, to turn it",
  });
  const note = el("span.note");
  const bar = el("i");
  const buttons = el(
    "div.group",
    note,
    homeButton(context),
    pictureButton(context, () => panel),
    filmButton(context, () => panel),
  );
  const area = el("div.area", canvas, splitHandle(context), ghostTag(context), el("div.progress", bar));
  const panel: HTMLElement = el(
    "section.panel.material.stage",
    { "aria-label": "Material" },
    el("div.line.bar", el("h2", "Material"), buttons),
    area,
    el(
      "div.line.wrap.bar.bottom",
      el("div.line.wrap", shapeChoice(context), !isIsotropic(context.tables.grid) && grain(context)),
      el("div.line.wrap", lightChoice(context), lightSettings(context), exposure(context)),
    ),
    notices(context, "material"),
  );
  try {
    new LivePicture(context, canvas, (progress) => describe(progress, panel, note, bar));
    orbitOnDrag(context, canvas);
  } catch (error) {
    if (!(error instanceof NoCardError)) throw error;
    canvas.hidden = true;
    stillPictures(context, panel, area, error.message);
  }
  return panel;
}

function describe(
  { materials, loaded, samples, target, settled, shown }: Progress,
  panel: HTMLElement,
  note: HTMLElement,
  bar: HTMLElement,
): void {
  const which = materials === 1 ? "the table" : `${materials} tables`;
  const share = loaded < 1 ? loaded : samples / target;
  note.textContent =
    loaded < 1 ? `loading ${which}, ${Math.round(100 * loaded)} %` : `${samples} / ${target} samples`;
  bar.style.transform = `scaleX(${share < 1 ? share : 0})`;
  Object.assign(panel.dataset, { samples, ready: samples > 0, settled, shown });
}

function homeButton({ store }: Context): HTMLElement {
  const button = iconButton("home", "Turn back to the front", () => store.set({ orbit: HOME }));
  store.watch(["orbit"], ({ orbit }) => {
    button.hidden = orbit === HOME;
  });
  return button;
}

const TITLES: Partial<Record<Light, string>> = { points: "three lights" };

function lightChoice({ store }: Context): HTMLElement {
  const lights = LIGHTS.map((light) => [light, TITLES[light]] as const);
  const select = dropdown({ name: "light", "aria-label": "Light" }, lights, (light) => store.set({ light }));
  const own = el("option", { value: "own", hidden: true });
  select.append(own);
  store.watch(["light", "ownLight"], ({ light, ownLight }) => {
    own.hidden = ownLight === null;
    own.textContent = ownLight;
    select.value = light;
  });
  return select;
}

/** How the light is turned, and how the picture is toned. */
function lightSettings({ store }: Context): HTMLElement {
  const [min, max] = TURNS;
  const turn = el("input", {
    type: "range",
    name: "turn",
    min,
    max,
    step: 1,
    oninput: () => store.set({ turn: Number(turn.value) }),
  });
  const degrees = el("output");
  const tones = TONES.map((tone) => [tone, TONE_TITLES[tone]] as const);
  const tone = dropdown({ name: "tone" }, tones, (value) => store.set({ tone: value }));
  store.watch(["turn", "tone"], (state) => {
    turn.value = String(state.turn);
    degrees.textContent = `${state.turn}°`;
    tone.value = state.tone;
  });
  const form = popover(
    "Light",
    el("label.line.choice", "Turned (Shift and drag the object)", turn, degrees),
    el("label.line.choice", "Tone mapping", tone),
    el("p.quiet", "Your own light: drop a .hdr or .exr file anywhere."),
  );
  form.classList.add("low");
  return el(
    "div",
    iconButton("tune", "Turn the light, tone mapping", () => form.togglePopover()),
    form,
  );
}

/** How the material is turned against the tangent of the surface. */
function grain({ store }: Context): HTMLElement {
  const [min, max] = TURNS;
  const input = el("input", {
    ...{ type: "range", name: "grain", min, max, step: 1 },
    "aria-label": "Turn of the material in degrees",
    oninput: () => store.set({ grain: Number(input.value) }),
    ondblclick: () => store.set({ grain: 0 }),
  });
  const output = el("output");
  store.watch(["grain"], (state) => {
    input.value = String(state.grain);
    output.textContent = `${state.grain}°`;
  });
  const title = "Turn the material against the tangent of the surface (double click: 0)";
  return el("label.line.exposure", { title }, "grain", input, output);
}

const TONE_TITLES = { none: "none: colours as they are", agx: "AgX", filmic: "filmic (ACES)" } as const;

function exposure({ store }: Context): HTMLElement {
  const [min, max] = EXPOSURES;
  const input = el("input", {
    type: "range",
    min,
    max,
    step: 0.1,
    "aria-label": "Exposure in stops",
    oninput: () => store.set({ exposure: Number(input.value) }),
    ondblclick: () => store.set({ exposure: 0 }),
  });
  const output = el("output");
  store.watch(["exposure"], ({ exposure }) => {
    input.value = String(exposure);
    const sign = exposure > 0 ? "+" : exposure < 0 ? "−" : "";
    output.textContent = `${sign}${Math.abs(exposure).toFixed(1)} EV`;
  });
  return el("label.line.exposure", { title: "Exposure (double click: 0)" }, input, output);
}
