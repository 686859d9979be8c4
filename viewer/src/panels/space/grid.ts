// The materials side by side: filtered, in an order, to be looked at and chosen.

import type { Context } from "../../context";
import { dropdown, el } from "../../dom";
import { COLOURS, type Facets, GLOSSES, inOrder, KINDS, ORDERS, type Order } from "../../materials";
import { materialAsGhost } from "../../pointing";
import { type Shown, shownDocument } from "../../shown";
import type { State } from "../../state";

const KEYS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"];

export function materialGrid(context: Context): HTMLElement {
  const { store, names } = context;
  const items = new Map(names.map((name) => [name, item(context, name)]));
  const grid = el(
    "div.grid",
    { role: "group", "aria-label": "Materials", onkeydown: step },
    ...items.values(),
  );
  paintSeen(context, grid);
  const arrange = async ({ described, order, ...state }: State) => {
    const distances = order === "likeness" ? await likeness(context, state) : [];
    if (store.get().order !== order) return;
    const distance = (name: string) => distances[names.indexOf(name)] ?? 0;
    grid.append(...inOrder(described, order, distance).map(({ name }) => items.get(name)!));
  };
  // What is looked at stays where it is: likeness is to what was shown when it was asked for.
  store.watch(["described", "order"], (state) => void arrange(state));
  store.watch(["stops", "matches"], ({ stops, matches }) => {
    const hits = matches && new Set(matches);
    for (const [name, each] of items) {
      each.setAttribute("aria-pressed", String(stops.includes(name)));
      each.hidden = hits !== null && !hits.has(name);
    }
  });
  return grid;
}

/** How different people find each material from what is shown; what failed is said. */
async function likeness({ client, actions }: Context, state: Shown): Promise<readonly number[]> {
  try {
    const { distances } = await client.alike(shownDocument(state));
    actions.say("space", "likeness", null);
    return distances;
  } catch (error) {
    actions.say("space", "likeness", (error as Error).message);
    return [];
  }
}

function item({ store, actions }: Context, name: string): HTMLElement {
  const look = () => store.set({ hovered: name, pointed: materialAsGhost(name) });
  const leave = () => store.set({ hovered: null, pointed: null });
  return el(
    "button",
    {
      type: "button",
      title: name,
      onclick: () => actions.choose(name),
      onpointerenter: look,
      onpointerleave: leave,
      onfocus: look,
      onblur: leave,
    },
    el("canvas.picture", { "data-material": name, width: 0, height: 0 }),
    el("span.called", name),
  );
}

/** Pictures are there while they are seen, or nearly: those of thousands would take long, and room. */
function paintSeen({ thumbnails, signal }: Context, grid: HTMLElement): void {
  const seen = (entries: readonly IntersectionObserverEntry[]) => {
    for (const { target, isIntersecting } of entries) {
      const canvas = target as HTMLCanvasElement;
      if (isIntersecting) thumbnails.paint(canvas, canvas.dataset.material!);
      else canvas.width = canvas.height = 0;
    }
  };
  const observer = new IntersectionObserver(seen, { root: grid, rootMargin: "50% 0px" });
  for (const canvas of grid.querySelectorAll("canvas")) observer.observe(canvas);
  signal.addEventListener("abort", () => observer.disconnect());
}

/** Arrows go from one to the next, and up and down. */
function step(event: KeyboardEvent): void {
  const grid = event.currentTarget as HTMLElement;
  const shown = [...grid.querySelectorAll<HTMLElement>("button:not([hidden])")];
  const i = shown.indexOf(document.activeElement as HTMLElement);
  if (!KEYS.includes(event.key) || event.altKey || i < 0) return;
  event.preventDefault();
  event.stopPropagation();
  const columns = getComputedStyle(grid).gridTemplateColumns.split(" ").length;
  const by = [-1, 1, -columns, columns][KEYS.indexOf(event.key)]!;
  shown[i + by]?.focus();
}

/** What they have to be, how many are, and their order. */
export function gridFilters({ store }: Context): HTMLElement {
  const facet = <K extends keyof Facets>(key: K, any: string, values: readonly Exclude<Facets[K], "">[]) => {
    const options = [["", any] as const, ...values.map((value) => [value] as const)];
    const select = dropdown({ name: key, "aria-label": key }, options as never, (value: Facets[K]) =>
      store.set({ facets: { ...store.get().facets, [key]: value } }),
    );
    store.watch(["facets"], ({ facets }) => {
      select.value = facets[key];
    });
    return select;
  };
  const orders = ORDERS.map(
    (order) => [order, order === "library" ? "library's order" : `by ${order}`] as const,
  );
  const order = dropdown({ name: "order", "aria-label": "order" }, orders, (value: Order) =>
    store.set({ order: value }),
  );
  const count = el("span.quiet.count", { role: "status" });
  store.watch(["matches", "described"], ({ matches, described }) => {
    count.textContent = `${matches?.length ?? described.length} of ${described.length}`;
  });
  return el(
    "div.line.wrap.filters",
    facet("kind", "any kind", KINDS),
    facet("colour", "any colour", COLOURS),
    facet("gloss", "any gloss", GLOSSES),
    order,
    count,
  );
}
