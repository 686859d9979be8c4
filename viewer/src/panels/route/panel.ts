// The route: stops as chips, and a strip of small pictures that is the slider for t.

import { asCompared, asComparedKept, comparedStop } from "../../compared";
import type { Context } from "../../context";
import { el, icon, iconButton } from "../../dom";
import { notices } from "../notices";
import { stopList } from "./stops";
import { strip } from "./strip";

export function routePanel(context: Context): HTMLElement {
  const { store } = context;
  const value = el("b");
  store.watch(["t"], ({ t }) => {
    value.textContent = t.toFixed(3);
  });
  const beside = el("div.line.wrap.beside", compareChoice(context), el("span.t", "t = ", value));
  const behind = el("p.tag.behind", { role: "status" });
  const panel = el(
    "section.panel.route",
    { "aria-label": "Route" },
    el("div.line.stopped", playButton(context), stopList(context), beside),
    strip(context),
    behind,
    notices(context, "route"),
  );
  store.watch(["behind"], ({ behind: shown }) => {
    behind.textContent = `still shown: ${shown}`;
    behind.hidden = shown === null;
    context.root.classList.toggle("outdated", shown !== null);
  });
  return panel;
}

function playButton({ store }: Context): HTMLElement {
  const button = iconButton("play", "Play (space)", () => store.set({ playing: !store.get().playing }));
  store.watch(["playing"], ({ playing }) => {
    button.replaceChildren(icon(playing ? "pause" : "play"));
    button.setAttribute("aria-pressed", String(playing));
  });
  return button;
}

/** What is shown beside, in one picture: the same t in another space, or a stop. */
function compareChoice({ store, actions }: Context): HTMLElement {
  const spaces = store
    .get()
    .library.spaces.map(({ name, text }) => el("option", { value: name, title: text }, name));
  const materials = el("optgroup", { label: "a stop" });
  const select = el(
    "select.field",
    { name: "compare", onchange: () => actions.compareWith(select.value) },
    el("option", { value: "" }, "nothing"),
    el("optgroup", { label: "the same t in" }, ...spaces),
    materials,
  );
  const shortlist = el("optgroup", { label: "the shortlist" });
  select.append(shortlist);
  store.watch(["compare", "stops", "kept"], ({ compare, stops, kept }) => {
    const own = comparedStop(compare);
    const names = [...new Set([...stops, ...(own === null ? [] : [own])])];
    materials.replaceChildren(...names.map((name) => el("option", { value: asCompared(name) }, name)));
    shortlist.replaceChildren(
      ...kept.map((each) => el("option", { value: asComparedKept(each) }, each.name)),
    );
    shortlist.hidden = kept.length === 0;
    select.value = compare;
  });
  return el("label.line.choice", "compare with", select);
}
