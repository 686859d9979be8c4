// The recipe: what the material is made of, and taking it home.

import { fromHex, toHex } from "../colour";
import type { Context } from "../context";
import { download, el } from "../dom";
import { pointOf, withCoordinates } from "../place";
import { CHANNELS, type Ingredient, meanWeight, toDocument } from "../recipe";

const BODY = "Body colour";

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
      const many = recipe.length ? `${recipe.length} materials` : "";
      note.textContent = recipe.length === 1 ? "one measured material" : many;
    },
  );
  return el(
    "section.panel.recipe",
    { "aria-label": "Recipe" },
    {},
    el("div.titled", {}, {}, el("h2", {}, {}, "Recipe"), note),
    list,
    adjustment(context),
    exports(context),
  );
}

/** The body colour of the present material, to be changed: everything else stays as near as a mix can be. */
function adjustment({ store, actions }: Context): HTMLElement {
  const names = store.get().library.materials.map(({ name }) => name);
  const note = el("span.note", { role: "status" });
  const input = el(
    "input",
    { type: "color", "aria-label": "Body colour" },
    {
      oninput: () => {
        const { view, point, recipe } = store.get();
        if (view === null) return;
        // A matte surface of reflectance x has x / pi in 1/sr.
        const body = fromHex(input.value).map((x) => x / Math.PI);
        actions.goTo(withCoordinates(view, point ?? pointOf(view, names, recipe), BODY, body));
      },
    },
  );
  const label = el("label", {}, {}, input, "Body colour");
  const back = el(
    "button.button",
    { type: "button" },
    { onclick: () => actions.setT(store.get().t) },
    "Back to route",
  );
  const element = el("div.adjustment", {}, {}, label, note, back);
  store.watch(
    ({ view, recipe, place }) => [view, recipe, place] as const,
    ([view, recipe, place]) => {
      const has = view?.embeddings.some(({ name }) => name === BODY) ?? false;
      element.hidden = !has && place === null;
      label.hidden = !has;
      input.disabled = recipe.length === 0;
      back.hidden = place === null;
      note.textContent = place === null || place.inside ? "" : "no mix is just there: this is the nearest";
      if (view && has && recipe.length && !input.matches(":focus")) {
        const body = pointOf(view, names, recipe).slice(-3);
        input.value = toHex(body.map((x) => x * Math.PI));
      }
    },
  );
  return element;
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

function exports({ root, client, store }: Context): HTMLElement {
  const recipe = () => toDocument(store.get().library.name, store.get().recipe);
  const title = () => {
    const { stops, t, place } = store.get();
    if (place !== null) return "free-place";
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
            download(await client.exported(format, recipe()), name);
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
        const canvas = root.querySelector<HTMLCanvasElement>(".material .view:not([hidden])");
        canvas?.toBlob((blob) => blob && download(blob, `${title()}.png`));
      },
    },
    "Picture",
  );
  const buttons = [...tables, json, png];
  store.watch(
    ({ recipe }) => recipe.length === 0,
    (empty) => {
      for (const button of buttons) button.disabled = empty;
    },
  );
  return el("div.actions", {}, {}, ...buttons);
}
