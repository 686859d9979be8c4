// The keyboard: / searches, space plays, arrows move t, the rest is in the table.

import type { Context } from "./context";
import { keepShown } from "./panels/shortlist/panel";

const STEP = 0.01;

export function listenToKeys(context: Context): void {
  const { root, options, store, actions, signal } = context;
  const listen = (event: KeyboardEvent) => {
    const target = event.composedPath()[0] as HTMLElement;
    if (target.matches("input:not([type=range]), select")) return;
    const command = event.ctrlKey || event.metaKey;
    if (command && event.key.toLowerCase() === "z") (event.shiftKey ? actions.redo : actions.undo)();
    else if (command || event.altKey) return;
    else if (event.key === "/") root.querySelector<HTMLInputElement>("[name=search]")?.focus();
    else if (event.key === " " && !target.matches("button")) store.set({ playing: !store.get().playing });
    else if (event.key === "ArrowRight" && !target.matches("input"))
      actions.setT(store.get().t + step(event));
    else if (event.key === "ArrowLeft" && !target.matches("input")) actions.setT(store.get().t - step(event));
    else if (event.key.toLowerCase() === "p") keepShown(context);
    else if (event.key === "?") root.querySelector<HTMLElement>(".popover.help")?.togglePopover();
    else if (event.key === "Home" && !target.matches("input")) actions.setT(0);
    else if (event.key === "End" && !target.matches("input")) actions.setT(1);
    else return;
    event.preventDefault();
  };
  (options.keys ?? root).addEventListener("keydown", listen as EventListener, { signal });
}

function step(event: KeyboardEvent): number {
  return event.shiftKey ? 10 * STEP : STEP;
}
