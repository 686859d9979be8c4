// Taking the material home: its table, a fit or a scene for another program, its recipe.

import type { Context } from "../../context";
import { download, el } from "../../dom";
import { shownDocument } from "../../shown";
import { materialName } from "../../title";

interface Format {
  readonly text: string;
  readonly suffix: string;
  readonly title: string;
}

const zip = (text: string, id: string): Format => ({
  text,
  suffix: `-${id}.zip`,
  title: `A folder that ${text} renders as it is: the material, a scene and a page`,
});

export const FORMATS: Readonly<Record<string, Format>> = {
  merl: {
    text: "MERL file",
    suffix: ".binary",
    title: "The full table as a MERL file (35 MB on the MERL grid)",
  },
  bsdf: { text: ".bsdf", suffix: ".bsdf", title: "For Mitsuba's `measured` material; takes some seconds" },
  mtlx: { text: ".mtlx", suffix: ".mtlx", title: "OpenPBR in MaterialX, fitted: USD, Houdini, Maya, Arnold" },
  glb: { text: ".glb (Blender)", suffix: ".glb", title: "glTF, fitted: Blender, the web" },
  mitsuba: zip("Mitsuba 3", "mitsuba"),
  "pbrt-v4": zip("pbrt-v4", "pbrt-v4"),
  "pbrt-v2": zip("pbrt-v2", "pbrt-v2"),
};

const isScene = (format: string): boolean => FORMATS[format]?.suffix.endsWith(".zip") ?? false;

export function exports(context: Context): HTMLElement {
  const { store } = context;
  const { exports: offered } = store.get().library;
  const without = "Tables and fits: `halfway mix` and `halfway fit` make them of the recipe.";
  const note = el("p.note.taken", { role: "status" }, offered.length === 0 && without);
  const files = offered.filter((format) => !isScene(format));
  const tables = files.map((format, i) => fileButton(context, format, i === 0, note));
  const json = button("Recipe", "The weights, as `halfway mix` reads them", () => {
    const text = `${JSON.stringify(shownDocument(store.get()), null, 1)}\n`;
    download(new Blob([text], { type: "application/json" }), `${materialName(store.get())}.json`);
  });
  const controls = [...tables, json, ...sceneChoice(context, offered.filter(isScene), note)];
  for (const each of controls) each.disabled = true;
  let isReady = false;
  store.watch(["recipe"], ({ recipe }) => {
    if (isReady || recipe.length === 0) return;
    isReady = true;
    for (const each of controls) each.disabled = false;
  });
  return el("div.taking", el("div.line.wrap.actions", ...controls), note);
}

function fileButton(context: Context, format: string, isMain: boolean, note: HTMLElement): HTMLButtonElement {
  const { text, title } = FORMATS[format] ?? { text: format, title: "" };
  const element = button(text, title, () => void take(context, format, element, note));
  element.classList.toggle("main", isMain);
  return element;
}

/** A scene for a renderer, as a zip; none where there are no formats. */
function sceneChoice(
  context: Context,
  formats: readonly string[],
  note: HTMLElement,
): readonly HTMLSelectElement[] {
  const options = formats.map((format) => el("option", { value: format }, FORMATS[format]!.text));
  const choose = () => {
    const format = select.value;
    select.value = "";
    void take(context, format, select, note);
  };
  const label = "Scene for a renderer";
  const first = el("option", { value: "" }, "Scene for …");
  const select = el(
    "select.field",
    { name: "scene", "aria-label": label, onchange: choose },
    first,
    ...options,
  );
  return formats.length ? [select] : [];
}

async function take(
  context: Context,
  format: string,
  control: HTMLButtonElement | HTMLSelectElement,
  note: HTMLElement,
): Promise<void> {
  const { client, store, actions } = context;
  const name = `${materialName(store.get())}${FORMATS[format]?.suffix ?? `.${format}`}`;
  control.disabled = true;
  note.textContent = `${name}: being written …`;
  try {
    const { file, summary } = await client.exported(format, shownDocument(store.get()));
    download(file, name);
    note.textContent = summary ? `${name}: ${summary}` : "";
    actions.say("recipe", "export", null);
  } catch (error) {
    note.textContent = "";
    actions.say("recipe", "export", (error as Error).message);
  }
  control.disabled = false;
}

function button(text: string, title: string, onclick: () => void): HTMLButtonElement {
  return el("button.button", { type: "button", title, onclick }, text);
}
