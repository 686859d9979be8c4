// The materials side by side, where the space cannot be drawn.

import type { Context } from "../../context";
import { el } from "../../dom";

export function shelf({ store, actions, names, thumbnails }: Context): HTMLElement {
  const buttons = names.map((name) => {
    const onclick = () => actions.choose(name);
    return el(
      "button",
      { type: "button", title: name, "aria-label": name, onclick },
      thumbnails.canvas(name),
    );
  });
  store.watch(["stops", "matches"], ({ stops, matches }) => {
    names.forEach((name, i) => {
      buttons[i]!.setAttribute("aria-pressed", String(stops.includes(name)));
      buttons[i]!.hidden = matches !== null && !matches.includes(name);
    });
  });
  return el("div.shelf", { role: "group", "aria-label": "Materials" }, ...buttons);
}
