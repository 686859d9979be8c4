// The route: stops as chips, and a strip of small pictures that is the slider for t.

import type { Context } from "../context";
import { el, icon, iconButton } from "../dom";
import { comparedStop } from "../state";
import { strip } from "./strip";

export function routePanel(context: Context): HTMLElement {
  const { store } = context;
  const problem = el("p.problem", { role: "alert" });
  store.watch(
    (state) => state.problem,
    (text) => {
      problem.textContent = text;
      problem.hidden = text === null;
    },
  );
  const value = el("b");
  store.watch(
    ({ t }) => t,
    (t) => {
      value.textContent = t.toFixed(3);
    },
  );
  return el(
    "section.panel.route",
    { "aria-label": "Route" },
    {},
    el(
      "div.row",
      {},
      {},
      playButton(context),
      stops(context),
      el("div.group", {}, {}, compareChoice(context), el("span.t", {}, {}, "t = ", value)),
    ),
    strip(context),
    problem,
  );
}

function playButton({ store }: Context): HTMLElement {
  const button = iconButton("play", "Play (space)", () => store.set({ playing: !store.get().playing }));
  store.watch(
    ({ playing }) => playing,
    (playing) => {
      button.replaceChildren(icon(playing ? "pause" : "play"));
      button.setAttribute("aria-pressed", String(playing));
    },
  );
  return button;
}

function stops(context: Context): HTMLElement {
  const { store, actions } = context;
  // Of the list, not of each stop: one that is taken away is never left.
  const list = el(
    "ol.stops",
    {},
    {
      onpointerover: ({ target }) => {
        const stop = (target as Element).closest<HTMLElement>("[data-stop]");
        store.set({ hovered: stop?.dataset.stop ?? null });
      },
      onpointerleave: () => store.set({ hovered: null }),
    },
  );
  store.watch(
    ({ stops, slot }) => [stops, slot] as const,
    ([stops, slot]) => {
      const focused = list.matches(":focus-within");
      list.replaceChildren(
        ...stops.map((name, i) =>
          el(
            "li",
            {},
            {},
            i > 0 && el("span.arrow", { "aria-hidden": "true" }, {}, "→"),
            chip(context, name, i),
          ),
        ),
        slot === stops.length
          ? el(
              "li",
              {},
              {},
              el("span.arrow", {}, {}, "→"),
              el(
                "span.chip.empty",
                { "data-selected": "true" },
                {},
                el(
                  "button",
                  { type: "button" },
                  { onclick: () => actions.selectSlot(stops.length - 1) },
                  "choose a material in the space or the search",
                ),
              ),
            )
          : el(
              "li",
              {},
              {},
              iconButton("plus", "Add a stop", () => actions.selectSlot(stops.length)),
            ),
      );
      // What had the focus is gone.
      if (focused) list.querySelector<HTMLElement>("[data-selected=true] > button")?.focus();
    },
  );
  return list;
}

function chip({ store, actions, thumbnails }: Context, name: string, i: number): HTMLElement {
  const { stops, slot } = store.get();
  const remove = stops.length > 2 && iconButton("close", `Remove ${name}`, () => actions.removeStop(i));
  const select = el(
    "button",
    {
      type: "button",
      title: `${name}. The next material you choose goes here. Drag, or Alt and an arrow, moves it`,
      "aria-pressed": i === slot ? "true" : "false",
    },
    {
      onclick: () => actions.selectSlot(i),
      onkeydown: (event) => {
        if (!event.altKey || (event.key !== "ArrowLeft" && event.key !== "ArrowRight")) return;
        event.preventDefault();
        actions.moveStop(i, i + (event.key === "ArrowRight" ? 1 : -1));
      },
    },
    thumbnails.canvas(name),
    el("span.name", {}, {}, name),
  );
  const element = el(
    "span.chip",
    { draggable: "true", "data-selected": i === slot ? "true" : "false", "data-stop": name },
    {
      ondragstart: (event) => {
        event.dataTransfer?.setData("text/x-halfway-stop", String(i));
        element.dataset.dragged = "true";
      },
      ondragend: () => {
        element.dataset.dragged = "false";
      },
      ondragover: (event) => event.preventDefault(),
      ondrop: (event) => {
        const from = Number.parseInt(event.dataTransfer?.getData("text/x-halfway-stop") ?? "", 10);
        if (Number.isFinite(from)) actions.moveStop(from, i);
      },
    },
    select,
    remove,
  );
  return element;
}

/** What is shown beside, in one picture: the same t in another space, or a stop. */
function compareChoice({ store, actions }: Context): HTMLElement {
  const { library } = store.get();
  const materials = el("optgroup", { label: "a stop" });
  const select = el(
    "select.field",
    { name: "compare" },
    { onchange: () => actions.compareWith(select.value) },
    el("option", { value: "" }, {}, "nothing"),
    el(
      "optgroup",
      { label: "the same t in" },
      {},
      ...library.spaces.map(({ name, text }) => el("option", { value: name, title: text }, {}, name)),
    ),
    materials,
  );
  store.watch(
    ({ compare, stops }) => [compare, stops] as const,
    ([compare, stops]) => {
      const own = comparedStop(compare);
      const names = [...new Set([...stops, ...(own === null ? [] : [own])])];
      materials.replaceChildren(...names.map((name) => el("option", { value: `stop:${name}` }, {}, name)));
      select.value = compare;
    },
  );
  return el("label.choice", {}, {}, "compare with", select);
}
