// The stops as chips: chosen, removed, inserted, moved by dragging or by key.

import type { Context } from "../../context";
import { el, iconButton } from "../../dom";
import type { State } from "../../state";

/** A pointer that moved more, in CSS pixels, drags. */
const STILL = 6;

export function stopList(context: Context): HTMLElement {
  const { store } = context;
  // Of the list, not of each stop: one that is taken away is never left.
  const list = el("ol.line.stops", {
    tabindex: 0,
    "aria-label": "Stops",
    onpointerover: ({ target }) => {
      const stop = (target as Element).closest<HTMLElement>("[data-stop]");
      store.set({ hovered: stop?.dataset.stop ?? null });
    },
    onpointerleave: () => store.set({ hovered: null }),
    onpointerdown: (event) => drag(context, list, event),
  });
  store.watch(["stops", "slot", "inserting"], (state) => {
    const focused = list.matches(":focus-within") && !list.matches(":focus");
    list.replaceChildren(...items(context, state));
    const selected = list.querySelector<HTMLElement>("[data-selected=true]");
    // What had the focus is gone.
    if (focused) selected?.querySelector("button")?.focus();
    else selected?.scrollIntoView({ block: "nearest", inline: "nearest" });
  });
  return list;
}

/** The stops, and where the next one comes if it replaces none. */
function items(context: Context, { stops, slot, inserting }: State): HTMLElement[] {
  const chips: HTMLElement[] = stops.map((name, i) =>
    el("li.line", i > 0 && between(context, i), chip(context, name, i)),
  );
  const { selectSlot } = context.actions;
  if (inserting)
    return chips
      .toSpliced(
        slot,
        0,
        empty(() => selectSlot(slot)),
      )
      .concat(plus(context));
  return [...chips, slot < stops.length ? plus(context) : empty(() => selectSlot(stops.length - 1))];
}

/** From one stop to the next; another comes between them. */
function between({ store, actions }: Context, i: number): HTMLElement {
  const { stops } = store.get();
  const label = `Insert a stop between ${stops[i - 1]} and ${stops[i]}`;
  return el(
    "button.arrow",
    { type: "button", title: label, "aria-label": label, onclick: () => actions.insertAt(i) },
    "→",
  );
}

function plus({ store, actions }: Context): HTMLElement {
  return el(
    "li",
    iconButton("plus", "Add a stop", () => actions.selectSlot(store.get().stops.length)),
  );
}

/** Where the next material goes. */
function empty(cancel: () => void): HTMLElement {
  const text = "choose a material in the space or the search";
  const back = el("button.line", { type: "button", onclick: cancel }, text);
  return el("li.line", el("span.line.chip.empty", { "data-selected": "true" }, back));
}

function chip(context: Context, name: string, i: number): HTMLElement {
  const { store, actions } = context;
  const { stops, slot, inserting } = store.get();
  return el(
    "span.line.chip",
    { "data-selected": String(i === slot && !inserting), "data-stop": name, "data-index": i },
    selectButton(context, name, i),
    stops.length > 2 && iconButton("close", `Remove ${name}`, () => actions.removeStop(i)),
  );
}

/** Drag a stop to another one's place: by the mouse, or with a finger by its picture. */
function drag(
  { actions }: Context,
  list: HTMLElement,
  { target, pointerType, clientX: x, clientY: y }: PointerEvent,
) {
  const chip = (target as Element).closest<HTMLElement>("[data-index]");
  if (!chip || (pointerType !== "mouse" && !(target as Element).matches(".thumbnail"))) return;
  const over = (event: PointerEvent) =>
    document.elementsFromPoint(event.clientX, event.clientY).find((each) => each.matches("[data-index]"));
  const mark = (other: Element | undefined) => {
    for (const each of list.querySelectorAll("[data-target]")) each.removeAttribute("data-target");
    other?.setAttribute("data-target", "");
  };
  const move = (event: PointerEvent) => {
    if (Math.hypot(event.clientX - x, event.clientY - y) > STILL) chip.dataset.dragged = "true";
    if (chip.dataset.dragged) mark(over(event));
  };
  const end = (event: PointerEvent) => {
    ended.abort();
    const to = event.type === "pointerup" && chip.dataset.dragged ? over(event) : undefined;
    delete chip.dataset.dragged;
    mark(undefined);
    if (to) actions.moveStop(indexOf(chip), indexOf(to));
  };
  const ended = new AbortController();
  const { signal } = ended;
  addEventListener("pointermove", move, { signal });
  addEventListener("pointerup", end, { signal });
  addEventListener("pointercancel", end, { signal });
}

function indexOf(chip: Element): number {
  return Number(chip.getAttribute("data-index"));
}

function selectButton({ store, actions, thumbnails }: Context, name: string, i: number): HTMLElement {
  return el(
    "button.line",
    {
      type: "button",
      title: `${name}. The next material you choose goes here. Drag, or Alt and an arrow, moves it`,
      "aria-pressed": String(i === store.get().slot && !store.get().inserting),
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
