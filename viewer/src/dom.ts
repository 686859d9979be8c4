// Elements without a framework.

type Child = Node | string | null | undefined | false;
type Listeners = { [K in keyof HTMLElementEventMap as `on${K}`]?: (event: HTMLElementEventMap[K]) => void };
// biome-ignore format: a line each would take a page.
type Attribute =
  | "accept" | "autocomplete" | "disabled" | "download" | "draggable" | "height" | "hidden" | "href" | "id" | "label" | "max" | "min"
  | "name" | "placeholder" | "popover" | "role" | "spellcheck" | "step" | "tabindex" | "title" | "type" | "value" | "width"
  | `aria-${string}` | `data-${string}`;
type Properties = Listeners & { [K in Attribute]?: string | number | boolean | null | undefined };

/** `el("button.chip", { title: "...", onclick }, ...children)`; what is false, null or undefined is left out. */
export function el<K extends keyof HTMLElementTagNameMap>(
  selector: K | `${K}.${string}`,
  ...parts: (Properties | Child)[]
): HTMLElementTagNameMap[K] {
  const [tag, ...classes] = selector.split(".");
  const element = document.createElement(tag as K);
  if (classes.length) element.className = classes.join(" ");
  for (const part of parts) {
    if (part instanceof Node || typeof part === "string") element.append(part);
    else for (const [key, value] of Object.entries(part || {})) setProperty(element, key, value);
  }
  return element;
}

function setProperty(element: HTMLElement, key: string, value: unknown): void {
  if (typeof value === "function") element.addEventListener(key.slice(2), value as EventListener);
  else if (value !== undefined && value !== null && value !== false)
    element.setAttribute(key, value === true ? "" : String(value));
}
const ICONS = {
  play: "M5 3.5v9l7.5-4.5z",
  pause: "M4.5 3.5h2.5v9H4.5zM9 3.5h2.5v9H9z",
  plus: "M7.25 3h1.5v4.25H13v1.5H8.75V13h-1.5V8.75H3v-1.5h4.25z",
  close: "M4.3 3.2 8 6.9l3.7-3.7 1.1 1.1L9.1 8l3.7 3.7-1.1 1.1L8 9.1l-3.7 3.7-1.1-1.1L6.9 8 3.2 4.3z",
  undo: "M6.2 3 2.5 6.5 6.2 10V7.6h3.3a2.2 2.2 0 0 1 0 4.4H6v1.5h3.5a3.7 3.7 0 0 0 0-7.4H6.2z",
  redo: "M9.8 3l3.7 3.5L9.8 10V7.6H6.5a2.2 2.2 0 0 0 0 4.4H10v1.5H6.5a3.7 3.7 0 0 1 0-7.4h3.3z",
  theme: "M8 2a6 6 0 1 0 0 12A6 6 0 0 0 8 2zm0 1.5v9a4.5 4.5 0 0 1 0-9z",
  link: "M6.6 9.4a2.6 2.6 0 0 1 0-3.7l2-2a2.6 2.6 0 0 1 3.7 3.7l-1 1-1-1 1-1a1.2 1.2 0 0 0-1.7-1.7l-2 2a1.2 1.2 0 0 0 0 1.7zm2.8-2.8a2.6 2.6 0 0 1 0 3.7l-2 2a2.6 2.6 0 0 1-3.7-3.7l1-1 1 1-1 1a1.2 1.2 0 0 0 1.7 1.7l2-2a1.2 1.2 0 0 0 0-1.7z",
  camera:
    "M5.8 3h4.4l1 1.6H13a1.2 1.2 0 0 1 1.2 1.2v6A1.2 1.2 0 0 1 13 13H3a1.2 1.2 0 0 1-1.2-1.2v-6A1.2 1.2 0 0 1 3 4.6h1.8zM8 6a2.7 2.7 0 1 0 0 5.4A2.7 2.7 0 0 0 8 6zm0 1.4a1.3 1.3 0 1 1 0 2.6 1.3 1.3 0 0 1 0-2.6z",
  film: "M3 3h10a1 1 0 0 1 1 1v8a1 1 0 0 1-1 1H3a1 1 0 0 1-1-1V4a1 1 0 0 1 1-1zm.5 1.3v1.6h1.4V4.3zm0 2.9v1.6h1.4V7.2zm0 2.9v1.6h1.4v-1.6zm7.6-5.8v1.6h1.4V4.3zm0 2.9v1.6h1.4V7.2zm0 2.9v1.6h1.4v-1.6zM6.2 4.3v3h3.6v-3zm0 4.4v3h3.6v-3z",
  terminal:
    "M2.5 3h11A1.5 1.5 0 0 1 15 4.5v7a1.5 1.5 0 0 1-1.5 1.5h-11A1.5 1.5 0 0 1 1 11.5v-7A1.5 1.5 0 0 1 2.5 3zm0 1.5v7h11v-7zm1.1 1.7 1-1L7.4 8l-2.8 2.8-1-1L5.4 8zM8 9.7h4v1.3H8z",
  tune: "M2 4h6.2a2 2 0 0 1 3.6 0H14v1.5h-2.2a2 2 0 0 1-3.6 0H2zm0 6.5h2.2a2 2 0 0 1 3.6 0H14V12H7.8a2 2 0 0 1-3.6 0H2z",
  help: "M8 1.5a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13zm0 1.5a5 5 0 1 1 0 10A5 5 0 0 1 8 3zm0 1.3c-1.5 0-2.5.9-2.6 2.3h1.5c0-.6.4-1 1.1-1 .6 0 1 .4 1 .9 0 .5-.3.7-.9 1.1-.7.5-1 .9-.9 1.9h1.4c0-.6.2-.8.8-1.2.7-.5 1.2-1 1.2-1.9 0-1.3-1.1-2.1-2.6-2.1zM7.2 10.5v1.5h1.6v-1.5z",
  more: "M3 6.6a1.4 1.4 0 1 1 0 2.8 1.4 1.4 0 0 1 0-2.8zm5 0a1.4 1.4 0 1 1 0 2.8 1.4 1.4 0 0 1 0-2.8zm5 0a1.4 1.4 0 1 1 0 2.8 1.4 1.4 0 0 1 0-2.8z",
  save: "M7.2 2.5h1.6v5.2l1.9-1.9 1.1 1.1L8 10.7 4.2 6.9l1.1-1.1 1.9 1.9zM3 12h10v1.5H3z",
  home: "M8 2.6 2.5 7.5l1 1.1.9-.8v5.4h2.8V10h1.6v3.2h2.8V7.8l.9.8 1-1.1z",
} as const;

export type Icon = keyof typeof ICONS;

export function icon(name: Icon): SVGSVGElement {
  const namespace = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(namespace, "svg");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(namespace, "path");
  path.setAttribute("d", ICONS[name]);
  svg.append(path);
  return svg;
}

/** A small window that opens at the button, and goes with Escape or a click beside it. */
export function popover(title: string, ...children: Child[]): HTMLElement {
  return el(
    "div.popover",
    { popover: "auto", role: "dialog", "aria-label": title },
    el("h2", title),
    ...children,
  );
}

export function iconButton(name: Icon, label: string, onclick: () => void): HTMLButtonElement {
  return el("button.icon", { type: "button", title: label, "aria-label": label, onclick }, icon(name));
}

/** What can be chosen: its value, what is written, and a longer text. */
type Option<T extends string> = readonly [value: T, text?: string | undefined, title?: string];

/** Choices of which exactly one holds. */
export function segments<T extends string>(
  label: string,
  options: readonly Option<T>[],
  choose: (value: T) => void,
): { element: HTMLElement; mark: (value: T) => void } {
  const buttons = options.map(([value, text]) =>
    el("button", { type: "button", "data-value": value, onclick: () => choose(value) }, text ?? value),
  );
  const mark = (value: T) => {
    for (const button of buttons) button.setAttribute("aria-pressed", String(button.dataset.value === value));
  };
  return { element: el("div.segments", { role: "group", "aria-label": label }, ...buttons), mark };
}

/** The same as a list that opens. */
export function dropdown<T extends string>(
  properties: Properties,
  options: readonly Option<T>[],
  choose: (value: T) => void,
): HTMLSelectElement {
  const select = el("select.field", { ...properties, onchange: () => choose(select.value as T) });
  select.append(...options.map(([value, text, title]) => el("option", { value, title }, text ?? value)));
  return select;
}

/** Call `draw` with the size in device pixels now and whenever the element changes it. */
export function onResize(
  element: HTMLElement,
  draw: (width: number, height: number, ratio: number) => void,
): void {
  new ResizeObserver(() => {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const { clientWidth, clientHeight } = element;
    if (clientWidth > 0 && clientHeight > 0) {
      draw(Math.round(clientWidth * ratio), Math.round(clientHeight * ratio), ratio);
    }
  }).observe(element);
}

/** A custom property of the style sheet, as it holds inside `root`. */
export function style(root: HTMLElement, name: string): string {
  return getComputedStyle(root).getPropertyValue(name).trim();
}

export function download(blob: Blob, name: string): void {
  const url = URL.createObjectURL(blob);
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
