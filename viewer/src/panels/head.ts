// The head: the library, the search, the space, undo, theme and link.

import type { Context } from "../context";
import { el, icon, iconButton } from "../dom";
import type { Theme } from "../state";

export function head(context: Context): HTMLElement {
  const { store, actions, options } = context;
  const { library } = store.get();
  const undo = iconButton("undo", "Undo (Ctrl+Z)", actions.undo);
  const redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", actions.redo);
  store.watch(
    ({ past, future }) => [past, future] as const,
    ([past, future]) => {
      undo.disabled = past.length === 0;
      redo.disabled = future.length === 0;
    },
  );
  const about = `${library.name}: ${library.description}`;
  return el(
    "header.head",
    {},
    {},
    el("h1.brand", {}, {}, el("i"), "halfway"),
    el("p.about", { title: `${about}\n${library.source}\n${library.licence}` }, {}, about),
    search(context),
    choice(
      context,
      "space",
      "Space",
      library.spaces.map(({ name, text }) => [name, text] as const),
      actions.setSpace,
    ),
    library.paces.length > 1 &&
      choice(
        context,
        "pace",
        "Pace",
        library.paces.map((name) => [name, ""] as const),
        actions.setPace,
      ),
    el("div.group", {}, {}, undo, redo, themeButton(context), options.address && linkButton(options.address)),
  );
}

function choice(
  { store }: Context,
  key: "space" | "pace",
  title: string,
  options: readonly (readonly [string, string])[],
  choose: (name: string) => void,
): HTMLElement {
  const select = el(
    "select.field",
    { name: key },
    { onchange: () => choose(select.value) },
    ...options.map(([name, text]) => el("option", { value: name, title: text }, {}, name)),
  );
  store.watch(
    (state) => state[key],
    (name) => {
      select.value = name;
      select.title = options.find(([option]) => option === name)?.[1] ?? "";
    },
  );
  return el("label.choice", {}, {}, title, select);
}

function themeButton({ store }: Context): HTMLElement {
  const next: Record<string, Theme> = { light: "dark", dark: "light" };
  return iconButton("theme", "Dark or light", () => {
    store.set({ theme: next[store.get().scheme]! });
  });
}

function linkButton(address: () => string): HTMLElement {
  const button = iconButton("link", "Copy a link to this view", () => {
    navigator.clipboard.writeText(address()).then(
      () => flash("Copied"),
      () => flash("The address bar has the link"),
    );
  });
  const flash = (text: string) => {
    button.replaceChildren(text);
    button.style.width = "auto";
    setTimeout(() => {
      button.replaceChildren(icon("link"));
      button.style.width = "";
    }, 1200);
  };
  return button;
}

/** So many are listed; more is typed sooner than looked through. */
const MOST = 40;

function search({ store, actions, thumbnails }: Context): HTMLElement {
  const names = store.get().library.materials.map(({ name }) => name);
  // Another explorer of the same document has another list.
  const id = `results-${Math.random().toString(36).slice(2)}`;
  let matches: readonly string[] = [];
  let selected = 0;
  const list = el("ul.results", { id, role: "listbox", hidden: true });
  const input = el(
    "input.field",
    {
      name: "search",
      type: "search",
      placeholder: `Search ${names.length} materials`,
      autocomplete: "off",
      spellcheck: "false",
      role: "combobox",
      "aria-label": "Search materials",
      "aria-controls": id,
      "aria-expanded": "false",
    },
    {
      oninput: () => update(),
      onfocus: () => update(),
      onblur: () => close(),
      onkeydown: (event) => {
        if (event.key === "ArrowDown") mark(selected + 1);
        else if (event.key === "ArrowUp") mark(selected - 1);
        else if (event.key === "Enter") choose(matches[selected]);
        else if (event.key === "Escape") input.blur();
        else return;
        event.preventDefault();
      },
    },
  );
  const update = () => {
    const words = input.value
      .toLowerCase()
      .split(/[\s-]+/)
      .filter(Boolean);
    matches = names.filter((name) => words.every((word) => name.toLowerCase().includes(word)));
    store.set({ found: words.length ? matches : null });
    list.hidden = words.length === 0;
    input.setAttribute("aria-expanded", String(!list.hidden));
    matches = matches.slice(0, MOST);
    const items = matches.map((name, i) =>
      el(
        "li",
        { role: "option", id: `${id}-${i}` },
        {
          onpointerdown: (event) => {
            event.preventDefault();
            choose(name);
          },
        },
        thumbnails.canvas(name),
        name,
      ),
    );
    list.replaceChildren(...(items.length ? items : [el("li.none", {}, {}, "No material of this name")]));
    mark(0);
  };
  const mark = (i: number) => {
    selected = Math.min(Math.max(i, 0), Math.max(matches.length - 1, 0));
    [...list.children].forEach((item, j) => {
      item.setAttribute("aria-selected", String(j === selected));
      if (j === selected) item.scrollIntoView({ block: "nearest" });
    });
    input.setAttribute("aria-activedescendant", matches.length ? `${id}-${selected}` : "");
    if (!list.hidden) store.set({ hovered: matches[selected] ?? null });
  };
  const close = () => {
    list.hidden = true;
    input.setAttribute("aria-expanded", "false");
    store.set({ found: null, hovered: null });
  };
  const choose = (name: string | undefined) => {
    if (name === undefined) return;
    actions.choose(name);
    input.value = "";
    input.blur();
  };
  return el("div.search", {}, {}, input, el("kbd", {}, {}, "/"), list);
}
