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

function exports({ store }: Context): HTMLElement {
  const document = () => toDocument(store.get().library.name, store.get().recipe);
  const title = () => {
    const { stops, t } = store.get();
    return `${stops[0]}-to-${stops.at(-1)}-${t.toFixed(3)}`;
  };
  const merl = el(
    "button.button.main",
    { type: "button", title: "The full table as a MERL file (35 MB on the MERL grid)" },
    {
      onclick: async () => {
        merl.disabled = true;
        try {
          download(await api.merlFile(document()), `${title()}.binary`);
        } catch (error) {
          store.set({ problem: (error as Error).message });
        }
        merl.disabled = false;
      },
    },
    "MERL file",
  );
  const json = el(
    "button.button",
    { type: "button", title: "The weights, as `halfway mix` reads them" },
    {
      onclick: () =>
        download(
          new Blob([`${JSON.stringify(document(), null, 1)}\n`], { type: "application/json" }),
          `${title()}.json`,
        ),
    },
    "Recipe JSON",
  );
  const png = el(
    "button.button",
    { type: "button", title: "The picture, with a transparent background" },
    {
      onclick: () => {
        window.document
          .querySelector<HTMLCanvasElement>("#material")
          ?.toBlob((blob) => blob && download(blob, `${title()}.png`));
      },
    },
    "Picture",
  );
  return el("div.actions", {}, {}, merl, json, png);
}
