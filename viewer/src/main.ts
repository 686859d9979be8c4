// The page that `halfway view` serves, or writes: one explorer that fills the window, its place in the address.

import { Problem } from "./api/client";
import { files } from "./api/files";
import { http } from "./api/http";
import { mount } from "./mount";
import { fromHash, unknownIn } from "./permalink";
import type { Theme } from "./state";
import "./styles/window.css";

const THEME = "halfway-theme";
const KEPT = "halfway-shortlist ";

// A page that was written says where its data are.
const data = document.querySelector<HTMLMetaElement>("meta[name=halfway-data]")?.content;

mount(document.querySelector<HTMLElement>("#app")!, data ? files(data) : http, {
  fragment: location.hash,
  onFragment: (fragment) => history.replaceState(null, "", fragment),
  onTitle: (title) => {
    document.title = `${title} · halfway`;
  },
  address: () => location.href,
  theme: (localStorage.getItem(THEME) ?? "auto") as Theme,
  onTheme: (theme) => localStorage.setItem(THEME, theme),
  kept: (library) => localStorage.getItem(KEPT + library),
  onKept: (library, text) => localStorage.setItem(KEPT + library, text),
  restart: (fragment) => {
    history.replaceState(null, "", fragment);
    location.reload();
  },
  keys: document,
}).then(
  // Another link in the address bar of the same page loads nothing anew.
  ({ store, actions }) =>
    addEventListener("hashchange", ({ newURL }) => {
      const { library } = store.get();
      // The address itself may be rewritten by now, to say what was shown before.
      const { hash } = new URL(newURL);
      actions.visit(fromHash(hash, library), unknownIn(hash, library));
    }),
  (error: unknown) => {
    // What a person can act on is on the page already.
    if (!(error instanceof Problem)) throw error;
  },
);
