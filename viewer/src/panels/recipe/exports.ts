// Taking the material home: its table, its recipe.

import type { Context } from "../../context";
import { download, el } from "../../dom";
import { toDocument } from "../../recipe";
import { materialName } from "../../title";

const FORMATS: Readonly<Record<string, { text: string; suffix: string; title: string }>> = {
  merl: {
    text: "MERL file",
    suffix: "binary",
    title: "The full table as a MERL file (35 MB on the MERL grid)",
  },
  bsdf: { text: ".bsdf", suffix: "bsdf", title: "For Mitsuba's `measured` material; takes some seconds" },
};

export function exports(context: Context): HTMLElement {
  const { store } = context;
  const tables = store.get().library.exports.map((format, i) => tableButton(context, format, i === 0));
  const json = button("Recipe", "The weights, as `halfway mix` reads them", () => {
    const text = `${JSON.stringify(recipeIn(context), null, 1)}\n`;
    download(new Blob([text], { type: "application/json" }), `${materialName(store.get())}.json`);
  });
  const buttons = [...tables, json];
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
  const { client, store, actions } = context;
  const { text, suffix, title: about } = FORMATS[format] ?? { text: format, suffix: format, title: "" };
  const element = button(text, about, async () => {
    element.disabled = true;
    const name = `${materialName(store.get())}.${suffix}`;
    try {
      download(await client.exported(format, recipeIn(context)), name);
      actions.say("recipe", format, null);
    } catch (error) {
      actions.say("recipe", format, (error as Error).message);
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
