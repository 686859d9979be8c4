// The search: the materials that fit all the words, to be looked at and chosen by key or by pointer.

import type { Context } from "../context";
import { el } from "../dom";
import { clamp } from "../numbers";
import { materialAsGhost } from "../pointing";

const NOTHING = "None fits: try a colour, what it is made of, matte, satin, glossy, or like and a name";
const COMPARING = "Comparing …";
/** So many are listed; more is typed sooner than looked through. */
const MOST = 40;

export function search(context: Context): HTMLElement {
  return new Search(context).element;
}

class Search {
  readonly element: HTMLElement;
  // Another explorer of the same document has another list.
  private readonly id = `results-${Math.random().toString(36).slice(2)}`;
  private readonly list = el("ul", { id: this.id, role: "listbox" });
  private readonly taken = el("p.note", { role: "status" });
  private readonly results = el("div.results", { hidden: true }, this.taken, this.list);
  private readonly input: HTMLInputElement;
  private matches: readonly string[] = [];
  private selected = 0;

  constructor(private readonly context: Context) {
    this.input = el("input.field", {
      name: "search",
      type: "search",
      placeholder: `Search ${context.names.length} materials`,
      autocomplete: "off",
      spellcheck: "false",
      role: "combobox",
      "aria-label": "Search materials",
      "aria-controls": this.id,
      "aria-expanded": "false",
      oninput: () => this.update(),
      onfocus: () => this.update(),
      onblur: () => this.close(),
      onkeydown: (event) => this.press(event),
    });
    this.element = el("div.search", this.input, el("kbd", "/"), this.results);
    context.store.watch(["query", "matches", "alike"], ({ query, matches, alike }) => {
      const isAsked = query.trim() !== "";
      this.open(isAsked);
      this.taken.hidden = alike === null;
      this.taken.textContent = alike && `What people find most like ${alike.to}`;
      this.fill(isAsked ? (matches ?? []) : [], alike?.distances === null ? COMPARING : NOTHING);
    });
  }

  private press(event: KeyboardEvent): void {
    if (event.key === "ArrowDown") this.mark(this.selected + 1);
    else if (event.key === "ArrowUp") this.mark(this.selected - 1);
    else if (event.key === "Enter") this.choose(this.matches[this.selected]);
    else if (event.key === "Escape") this.input.blur();
    else return;
    event.preventDefault();
  }

  private update(): void {
    this.context.store.set({ query: this.input.value });
  }

  private fill(matches: readonly string[], otherwise: string): void {
    this.matches = matches.slice(0, MOST);
    const items = this.matches.map((name, i) => this.item(name, i));
    this.list.replaceChildren(...(items.length ? items : [el("li.line.none", otherwise)]));
    this.mark(0);
  }

  private item(name: string, i: number): HTMLElement {
    const onpointerdown = (event: Event) => {
      event.preventDefault();
      this.choose(name);
    };
    const picture = this.context.thumbnails.canvas(name);
    const onpointermove = () => this.selected !== i && this.mark(i);
    return el(
      "li.line",
      { role: "option", id: `${this.id}-${i}`, onpointerdown, onpointermove },
      picture,
      name,
    );
  }

  private mark(i: number): void {
    this.selected = clamp(i, 0, Math.max(this.matches.length - 1, 0));
    [...this.list.children].forEach((item, j) => {
      item.setAttribute("aria-selected", String(j === this.selected));
      if (j === this.selected) item.scrollIntoView({ block: "nearest" });
    });
    const marked = this.matches.length ? `${this.id}-${this.selected}` : "";
    this.input.setAttribute("aria-activedescendant", marked);
    const name = this.matches[this.selected] ?? null;
    if (!this.results.hidden)
      this.context.store.set({ hovered: name, pointed: name === null ? null : materialAsGhost(name) });
  }

  private open(isOpen: boolean): void {
    this.results.hidden = !isOpen;
    this.input.setAttribute("aria-expanded", String(isOpen));
  }

  private close(): void {
    this.context.store.set({ query: "", hovered: null, pointed: null });
  }

  private choose(name: string | undefined): void {
    if (name === undefined) return;
    this.context.actions.choose(name);
    this.input.value = "";
    this.input.blur();
  }
}
