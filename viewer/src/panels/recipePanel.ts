// The recipe: what the material is made of, and taking it home.

import * as api from "../api/client";
import { download, el } from "../dom";
import type { Context } from "../main";
import { CHANNELS, type Ingredient, meanWeight, toDocument } from "../recipe";

export function recipePanel(context: Context): HTMLElement {
  const { store, thumbnails } = context;
  const list = el("ol");
  const note = el("p.note");
  const rows = new Map<string, HTMLLIElement>();
  store.watch(
    ({ recipe }) => recipe,
    (recipe) => {
      const ordered = [...recipe].sort((a, b) => meanWeight(b) - meanWeight(a));
      const items = ordered.map((ingredient) => {
        const row =
          rows.get(ingredient.name) ?? newRow(context, thumbnails.canvas(ingredient.name), ingredient.name);
        rows.set(ingredient.name, row);
        fill(row, ingredient);
        return row;
      });
      if (items.some((item, i) => list.children[i] !== item) || list.children.length !== items.length) {
        list.replaceChildren(...items);
      }
      note.textContent = recipe.length === 1 ? "one measured material" : `${recipe.length} materials`;
    },
  );
  return el(
    "section.panel.recipe",
    { "aria-label": "Recipe" },
    {},
    el("div.titled", {}, {}, el("h2", {}, {}, "Recipe"), note),
    list,
    exports(context),
  );
}

function newRow({ store }: Context, picture: HTMLCanvasElement, name: string): HTMLLIElement {
  return el(
    "li",
    {},
    {
      onpointerenter: () => store.set({ hovered: name }),
      onpointerleave: () => store.set({ hovered: null }),
    },
    picture,
    el("span.name", { title: name }, {}, name),
    el("span.share"),
    el("span.bars", {}, {}, ...CHANNELS.map((channel) => el(`i.${channel}`))),
  );
}

function fill(row: HTMLLIElement, { weight }: Ingredient): void {
  const same = weight[0] === weight[1] && weight[1] === weight[2];
  const bars = row.querySelector<HTMLElement>(".bars")!;
  bars.className = same ? "bars same" : "bars";
  CHANNELS.forEach((_, c) => {
    const bar = bars.children[c] as HTMLElement;
    bar.hidden = same && c > 0;
    bar.style.transform = `scaleX(${weight[c]})`;
    bar.style.backgroundColor = same ? "var(--accent)" : "";
  });
  const percent = (w: number) => (w === 0 ? "0" : w < 0.005 ? "<1" : String(Math.round(100 * w)));
  row.querySelector(".share")!.textContent = same
    ? `${percent(weight[0])} %`
    : `${weight.map(percent).join(" · ")} %`;
}

const FORMATS: Readonly<Record<string, { text: string; suffix: string; title: string }>> = {
  merl: {
    text: "MERL file",
    suffix: "binary",
    title: "The full table as a MERL file (35 MB on the MERL grid)",
  },
  bsdf: { text: ".bsdf", suffix: "bsdf", title: "For Mitsuba's `measured` material; takes some seconds" },
};

function exports({ store }: Context): HTMLElement {
  const recipe = () => toDocument(store.get().library.name, store.get().recipe);
  const title = () => {
    const { stops, t } = store.get();
    return `${stops[0]}-to-${stops.at(-1)}-${t.toFixed(3)}`;
  };
  const tables = store.get().library.exports.map((format, i) => {
    const { text, suffix, title: about } = FORMATS[format] ?? { text: format, suffix: format, title: "" };
    const button = el(
      i === 0 ? "button.button.main" : "button.button",
      { type: "button", title: about },
      {
        onclick: async () => {
          button.disabled = true;
          const name = `${title()}.${suffix}`;
          try {
            download(await api.exported(format, recipe()), name);
          } catch (error) {
            store.set({ problem: (error as Error).message });
          }
          button.disabled = false;
        },
      },
      text,
    );
    return button;
  });
  const json = el(
    "button.button",
    { type: "button", title: "The weights, as `halfway mix` reads them" },
    {
      onclick: () => {
        const text = `${JSON.stringify(recipe(), null, 1)}\n`;
        download(new Blob([text], { type: "application/json" }), `${title()}.json`);
      },
    },
    "Recipe",
  );
  const png = el(
    "button.button",
    { type: "button", title: "The picture, with a transparent background" },
    {
      onclick: () => {
        const canvas = document.querySelector<HTMLCanvasElement>("#material");
        canvas?.toBlob((blob) => blob && download(blob, `${title()}.png`));
      },
    },
    "Picture",
  );
  return el("div.actions", {}, {}, ...tables, json, png);
}
