// What every panel is given.

import type { Actions } from "./actions";
import type { Client } from "./api/client";
import type { Lights } from "./render/lights";
import type { Tables } from "./render/tables";
import type { Linked, State, Theme } from "./state";
import type { Store } from "./store";
import type { Thumbnails } from "./thumbnails";

export interface Context {
  /** Everything that the page shows is inside; the style sheet's properties are its own. */
  readonly root: HTMLElement;
  readonly client: Client;
  readonly options: Options;
  readonly store: Store<State>;
  /** Of all materials, in the library's order. */
  readonly names: readonly string[];
  readonly actions: Actions;
  readonly thumbnails: Thumbnails;
  readonly tables: Tables;
  readonly lights: Lights;
  /** Aborted when the page is taken away. */
  readonly signal: AbortSignal;
}

/** What the page takes from where it stands, and tells it. */
export interface Options {
  /** Where to begin: the fragment of a link (`#space=...&stops=...`). */
  readonly fragment?: string;
  /** Fields that replace those of the fragment. */
  readonly linked?: Partial<Linked>;
  /** Told the fragment that leads back here, some time after it changed. */
  readonly onFragment?: (fragment: string) => void;
  /** Told what is shown, in a few words. */
  readonly onTitle?: (title: string) => void;
  /** The address that "copy a link" copies; without it there is no such button. */
  readonly address?: () => string;
  readonly theme?: Theme;
  readonly onTheme?: (theme: Theme) => void;
  /** The shortlist of a library that was kept before, as text; and told when it is another. */
  readonly kept?: (library: string) => string | null;
  readonly onKept?: (library: string, text: string) => void;
  /** The library has other materials: begin again at a fragment. */
  readonly restart?: (fragment: string) => void;
  /** Where keys are listened to; the page's own element if it is left out. */
  readonly keys?: Document | HTMLElement;
}
