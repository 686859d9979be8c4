// The stops as chips: chosen, removed, moved by dragging or by key.

import type { Context } from "../../context";
import { el, iconButton } from "../../dom";

const DRAGGED = "text/x-halfway-stop";

export function stopList(context: Context): HTMLElement {
  const { store } = context;
  // Of the list, not of each stop: one that is taken away is never left.
  const list = el("ol.line.wrap.stops", {
    onpointerover: ({ target }) => {
      const stop = (target as Element).closest<HTMLElement>("[data-stop]");
      store.set({ hovered: stop?.dataset.stop ?? null });
    },
    onpointerleave: () => store.set({ hovered: null }),
  });
  store.watch(["stops", "slot"], ({ stops }) => {
    const focused = list.matches(":focus-within");
    const chips = stops.map((name, i) => el("li.line", i > 0 && arrow(), chip(context, name, i)));
    list.replaceChildren(...chips, next(context));
    // What had the focus is gone.
    if (focused) list.querySelector<HTMLElement>("[data-selected=true] > button")?.focus();
  });
  return list;
}

function arrow(): HTMLElement {
  return el("span.arrow", { "aria-hidden": "true" }, "→");
}

/** What follows the last stop: another one to come, or the button for it. */
function next({ store, actions }: Context): HTMLElement {
  const { stops, slot } = store.get();
  if (slot < stops.length)
    return el(
      "li",
      iconButton("plus", "Add a stop", () => actions.selectSlot(stops.length)),
    );
  const text = "choose a material in the space or the search";
  const back = el(
    "button.line",
    { type: "button", onclick: () => actions.selectSlot(stops.length - 1) },
    text,
  );
  return el("li.line", arrow(), el("span.line.chip.empty", { "data-selected": "true" }, back));
}

function chip(context: Context, name: string, i: number): HTMLElement {
  const { store, actions } = context;
  const { stops, slot } = store.get();
  const element = el(
    "span.line.chip",
    {
      draggable: "true",
      "data-selected": String(i === slot),
      "data-stop": name,
      ondragstart: (event) => {
        event.dataTransfer?.setData(DRAGGED, String(i));
        element.dataset.dragged = "true";
      },
      ondragend: () => {
        element.dataset.dragged = "false";
      },
      ondragover: (event) => event.preventDefault(),
      ondrop: (event) => {
        const from = Number.parseInt(event.dataTransfer?.getData(DRAGGED) ?? "", 10);
        if (Number.isFinite(from)) actions.moveStop(from, i);
      },
    },
    selectButton(context, name, i),
    stops.length > 2 && iconButton("close", `Remove ${name}`, () => actions.removeStop(i)),
  );
  return element;
}

function selectButton({ store, actions, thumbnails }: Context, name: string, i: number): HTMLElement {
  return el(
    "button.line",
    {
      type: "button",
      title: `${name}. The next material you choose goes here. Drag, or Alt and an arrow, moves it`,
      "aria-pressed": String(i === store.get().slot),
      onclick: () => actions.selectSlot(i),
      onkeydown: (event) => {
        if (!event.altKey || (event.key !== "ArrowLeft" && event.key !== "ArrowRight")) return;
        event.preventDefault();
        actions.moveStop(i, i + (event.key === "ArrowRight" ? 1 : -1));
      },
    },
    thumbnails.canvas(name),
    el("span.cut.name", name),
  );
}
