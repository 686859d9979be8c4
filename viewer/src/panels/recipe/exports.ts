// Taking the material home: its table, its recipe, its picture.

import type { Context } from "../../context";
import { download, el } from "../../dom";
import { toDocument } from "../../recipe";

const FORMATS: Readonly<Record<string, { text: string; suffix: string; title: string }>> = {
  merl: {
    text: "MERL file",
    suffix: "binary",
    title: "The full table as a MERL file (35 MB on the MERL grid)",
  },
  bsdf: { text: ".bsdf", suffix: "bsdf", title: "For Mitsuba's `measured` material; takes some seconds" },
};

export function exports(context: Context): HTMLElement {
  const { root, store } = context;
  const tables = store.get().library.exports.map((format, i) => tableButton(context, format, i === 0));
  const json = button("Recipe", "The weights, as `halfway mix` reads them", () => {
    const text = `${JSON.stringify(recipeIn(context), null, 1)}\n`;
    download(new Blob([text], { type: "application/json" }), `${title(context)}.json`);
  });
  const png = button("Picture", "The picture, with a transparent background", () => {
    // What is seen: the cover, where there is one.
    const seen = [".hold", ".view"].map((view) => `.material ${view}:not([hidden])`);
    const [canvas] = seen.map((view) => root.querySelector<HTMLCanvasElement>(view)).filter(Boolean);
    canvas?.toBlob((blob) => blob && download(blob, `${title(context)}.png`));
  });
  const buttons = [...tables, json, png];
  for (const each of buttons) each.disabled = true;
  let isReady = false;
  store.watch(["recipe"], ({ recipe }) => {
    if (isReady || recipe.length === 0) return;
    isReady = true;
    for (const each of buttons) each.disabled = false;
  });
  return el("div.line.wrap.actions", ...buttons);
}

function tableButton(context: Context, format: string, isMain: boolean): HTMLButtonElement {
  const { client, store } = context;
  const { text, suffix, title: about } = FORMATS[format] ?? { text: format, suffix: format, title: "" };
  const element = button(text, about, async () => {
    element.disabled = true;
    const name = `${title(context)}.${suffix}`;
    try {
      download(await client.exported(format, recipeIn(context)), name);
    } catch (error) {
      store.set({ problem: (error as Error).message });
    }
    element.disabled = false;
  });
  element.classList.toggle("main", isMain);
  return element;
}

function button(text: string, title: string, onclick: () => void): HTMLButtonElement {
  return el("button.button", { type: "button", title, onclick }, text);
}

function recipeIn({ store }: Context) {
  const { library, recipe } = store.get();
  return toDocument(library.name, recipe);
}

/** Of a file. */
function title({ store }: Context): string {
  const { stops, t, atPoint } = store.get();
  return atPoint === null ? `${stops[0]}-to-${stops.at(-1)}-${t.toFixed(3)}` : "free-place";
}
