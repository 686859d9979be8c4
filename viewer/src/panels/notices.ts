// What is to be said: beside the act that it is about, until its cause is gone or a person closes it; and what the page waits for.
//
// Notices lie over the panels, so that nothing moves when one comes.

import type { Context } from "../context";
import { el, iconButton } from "../dom";
import type { Notice, Panel } from "../state";

/** The notices of one panel. */
export function notices({ store, actions }: Context, panel: Panel): HTMLElement {
  const element = el("div.notices");
  const lines = new Map<Notice, HTMLElement>();
  store.watch(["notices"], (state) => {
    const own = state.notices.filter((notice) => notice.panel === panel);
    for (const [notice, line] of lines) {
      if (own.includes(notice)) continue;
      line.remove();
      lines.delete(notice);
    }
    for (const notice of own) {
      if (lines.has(notice)) continue;
      const close = iconButton("close", "Close", () => actions.say(panel, notice.cause, null));
      const line = el("p.line.problem", { role: "alert" }, el("span", notice.text), close);
      lines.set(notice, line);
      element.append(line);
    }
  });
  return element;
}

/** What is being computed and how far it is, or that nobody answers. */
export function status({ store }: Context): HTMLElement {
  const text = el("span");
  const bar = el("i");
  const element = el("p.status", { role: "status", hidden: true }, text, el("span.progress", bar));
  store.watch(["waiting"], ({ waiting }) => {
    element.hidden = waiting === null;
    if (waiting === null) return;
    text.textContent = waiting.text;
    element.classList.toggle("problem", !waiting.computed);
    bar.style.transform = `scaleX(${waiting.share ?? 0})`;
  });
  return element;
}

/** A canvas whose graphics card was taken away says so, and begins again when the browser gives it back. */
export function sayWhenLost(
  { actions }: Context,
  panel: Panel,
  canvas: HTMLCanvasElement,
  restored: () => void,
): void {
  const text =
    "The browser took the graphics card away: the picture comes back with it. If not, reload the page.";
  canvas.addEventListener("webglcontextlost", () => actions.say(panel, "card", text));
  canvas.addEventListener("webglcontextrestored", () => {
    actions.say(panel, "card", null);
    restored();
  });
}
