// The head: the library, the search, the space, undo, theme and link.

import type { LibrarySummary } from "../api/schema";
import { toCommand } from "../command";
import type { Context } from "../context";
import { dropdown, el, type Icon, icon, iconButton } from "../dom";
import type { Theme } from "../state";
import { helpButton } from "./help";
import { search } from "./search";

/** Milliseconds that a button says what it did. */
const SAID = 1200;
/** What each does, in a line. */
const BLENDS: Readonly<Record<string, string>> = {
  lobes: "highlights are brought to one width and mixed: one highlight that narrows",
  linear: "weighted sums, the paper's: two highlights on the way",
  root: "weighted sums of square roots: a dark material counts beside a bright one",
  log: "weighted sums of log(1 + f): linear where dark, geometric in highlights",
};

const PACES: Readonly<Record<string, string>> = {
  perceptual: "equal steps of t are equal to the eye",
  people: "equal steps of t are what people would call equal",
  uniform: "even in weights, the paper's",
};

export function head(context: Context): HTMLElement {
  const { store, options } = context;
  const { library } = store.get();
  const about = `${library.name}: ${library.description}`;
  const spaces = library.spaces.map(({ name, text }) => [name, text] as const);
  const blends = library.blends.map((name) => [name, BLENDS[name] ?? ""] as const);
  const paces = library.paces.map((name) => [name, PACES[name] ?? ""] as const);
  return el(
    "header.line.head",
    el("h1.line.brand", el("i"), "halfway"),
    el("p.cut.about", { title: `${about}\n${library.source}\n${library.licence}` }, about),
    isStandIn(library) &&
      el("span.badge", { title: `${library.source}\n${library.licence}` }, "stand-ins, not measurements"),
    search(context),
    choice(context, "space", "Space", spaces),
    blends.length > 1 && choice(context, "blend", "Blend", blends),
    paces.length > 1 && choice(context, "pace", "Pace", paces),
    el(
      "div.group",
      ...undoButtons(context),
      themeButton(context),
      options.address &&
        copyButton("link", "Copy a link to this view", options.address, "The address bar has the link"),
      copyButton(
        "terminal",
        "Copy the command that makes this picture",
        () => toCommand(store.get()),
        "The browser forbids it",
      ),
      helpButton(),
    ),
  );
}

/** Fits say so in their library's one line. */
function isStandIn({ description }: LibrarySummary): boolean {
  return description.includes("stand-in");
}

function choice(
  { store, actions }: Context,
  key: "space" | "blend" | "pace",
  title: string,
  texts: readonly (readonly [name: string, text: string])[],
): HTMLElement {
  const options = texts.map(([name, text]) => [name, name, text] as const);
  const select = dropdown({ name: key }, options, (name) => actions.go({ [key]: name }));
  store.watch([key], (state) => {
    select.value = state[key];
    select.title = new Map(texts).get(state[key]) ?? "";
  });
  return el("label.line.choice", title, select);
}

function undoButtons({ store, actions }: Context): HTMLElement[] {
  const undo = iconButton("undo", "Undo (Ctrl+Z)", actions.undo);
  const redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", actions.redo);
  store.watch(["past", "future"], ({ past, future }) => {
    undo.disabled = past.length === 0;
    redo.disabled = future.length === 0;
  });
  return [undo, redo];
}

function themeButton({ store }: Context): HTMLElement {
  const next: Record<string, Theme> = { light: "dark", dark: "light" };
  return iconButton("theme", "Dark or light", () => store.set({ theme: next[store.get().scheme]! }));
}

function copyButton(name: Icon, label: string, text: () => string, otherwise: string): HTMLElement {
  const button = iconButton(name, label, () => {
    navigator.clipboard.writeText(text()).then(
      () => flash("Copied"),
      () => flash(otherwise),
    );
  });
  const flash = (said: string) => {
    button.replaceChildren(said);
    button.style.width = "auto";
    setTimeout(() => {
      button.replaceChildren(icon(name));
      button.style.width = "";
    }, SAID);
  };
  return button;
}
