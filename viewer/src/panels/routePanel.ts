// The route: stops as chips, and a strip of small pictures that is the slider for t.

import { el, icon, iconButton, onResize, style } from "../dom";
import type { Context } from "../main";
import { recipeAt } from "../recipe";

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
    el("div.row", {}, {}, playButton(context), stops(context), el("span.t", {}, {}, "t = ", value)),
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
  const list = el("ol.stops");
  store.watch(
    ({ stops, slot }) => [stops, slot] as const,
    ([stops, slot]) => {
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
      title: "The next material you choose goes here. Drag, or Alt and an arrow, moves it",
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
    name,
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
      onpointerenter: () => store.set({ hovered: name }),
      onpointerleave: () => store.set({ hovered: null }),
    },
    select,
    remove,
  );
  return element;
}

/** Small pictures along t, ticks where the recipe changes its simplex, and a range input on top. */
function strip({ store, actions, thumbnails }: Context): HTMLElement {
  const canvas = el("canvas", { "aria-hidden": "true" });
  const head = el("div.playhead");
  const input = el(
    "input",
    { id: "t", type: "range", min: 0, max: 1, step: 0.001, "aria-label": "Position t on the route" },
    {
      oninput: () => {
        store.set({ playing: false });
        actions.setT(Number(input.value));
      },
    },
  );
  const element = el("div.strip", {}, {}, canvas, input, head);
  store.watch(
    ({ t }) => t,
    (t) => {
      input.value = String(t);
      // The middle of a range input's thumb stays half a thumb away from the ends.
      head.style.left = `calc(var(--side) / 2 + ${t} * (100% - var(--side)))`;
    },
  );
  const context = canvas.getContext("2d")!;
  const cell = document.createElement("canvas");
  cell.width = cell.height = thumbnails.size;
  const pen = cell.getContext("2d")!;
  const draw = () => {
    const { route } = store.get();
    const { width, height } = canvas;
    context.clearRect(0, 0, width, height);
    if (route === null || width === 0) return;
    const ratio = width / canvas.clientWidth;
    const side = Number.parseFloat(getComputedStyle(element).getPropertyValue("--side")) * ratio;
    const inset = side / 2;
    const count = Math.max(2, Math.floor((width - side) / (side * 1.07)) + 1);
    context.imageSmoothingQuality = "high";
    for (let i = 0; i < count; i++) {
      const t = i / (count - 1);
      pen.putImageData(thumbnails.picture(recipeAt(route, t)), 0, 0);
      const centre = inset + t * (width - 2 * inset);
      context.drawImage(cell, centre - side / 2, 0, side, side);
    }
    const line = (t: number, from: number, colour: string, thickness: number) => {
      context.fillStyle = colour;
      context.fillRect(inset + t * (width - 2 * inset) - thickness / 2, from, thickness, height - from);
    };
    context.fillStyle = style("--line");
    context.fillRect(inset, height - ratio, width - 2 * inset, ratio);
    for (const t of route.knots) line(t, height - 4 * ratio, style("--quiet"), ratio);
    for (const t of route.stop_t) line(t, height - 7 * ratio, style("--text"), 2 * ratio);
  };
  onResize(element, (width, height) => {
    canvas.width = width;
    canvas.height = height;
    draw();
  });
  store.watch(({ route }) => route, draw);
  document.addEventListener("themechange", draw);
  return element;
}
