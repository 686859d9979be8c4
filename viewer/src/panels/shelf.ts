// The materials side by side, where the space cannot be drawn.

import type { Context } from "../context";
import { el } from "../dom";

export function shelf({ store, actions, thumbnails }: Context): HTMLElement {
  const { materials } = store.get().library;
  const buttons = materials.map(({ name }) =>
    el(
      "button",
      { type: "button", title: name, "aria-label": name },
      { onclick: () => actions.choose(name) },
      thumbnails.canvas(name),
    ),
  );
  store.watch(
    ({ stops, found }) => [stops, found] as const,
    ([stops, found]) => {
      materials.forEach(({ name }, i) => {
        buttons[i]!.setAttribute("aria-pressed", String(stops.includes(name)));
        buttons[i]!.hidden = found !== null && !found.includes(name);
      });
    },
  );
  return el("div.shelf", { role: "group", "aria-label": "Materials" }, {}, ...buttons);
}
