// The page that `halfway view` serves: one explorer that fills the window, its place in the address.

import { http, Problem } from "./api/client";
import { mount } from "./mount";
import type { Theme } from "./state";
import "./styles/window.css";

const THEME = "halfway-theme";

mount(document.querySelector<HTMLElement>("#app")!, http, {
  fragment: location.hash,
  onFragment: (fragment) => history.replaceState(null, "", fragment),
  address: () => location.href,
  theme: (localStorage.getItem(THEME) ?? "auto") as Theme,
  onTheme: (theme) => localStorage.setItem(THEME, theme),
  keys: document,
}).catch((error: unknown) => {
  // What a person can act on is on the page already.
  if (!(error instanceof Problem)) throw error;
});
