// Files of a person's own, dropped anywhere on the page or chosen: what each is for is said by its name's end.

import { Problem } from "./api/client";
import { isIsotropic } from "./brdf/grid";
import type { Context } from "./context";
import { toHash } from "./permalink";
import { readLight } from "./render/environments";
import { readMesh } from "./render/meshes";
import { HOME } from "./scene";
import { fromText, isShortlist } from "./shortlist";
import type { Panel } from "./state";

interface Kind {
  readonly suffixes: readonly string[];
  readonly what: string;
  readonly open: (context: Context, file: File) => Promise<void>;
}

const KINDS: readonly Kind[] = [
  { suffixes: ["ply", "obj"], what: "a mesh", open: openMesh },
  { suffixes: ["binary", "bsdf", "h5"], what: "a measurement", open: addMeasurement },
  { suffixes: ["hdr", "exr"], what: "a light", open: openLight },
  { suffixes: ["json"], what: "a recipe or a shortlist", open: openRecipes },
];

/** Read a file and show what is in it; what is wrong with it is said in `panel`. */
export async function openFile(context: Context, file: File, panel: Panel): Promise<void> {
  const { actions } = context;
  try {
    const suffix = file.name.toLowerCase().split(".").at(-1)!;
    const kind = KINDS.find(({ suffixes }) => suffixes.includes(suffix));
    if (kind === undefined)
      throw new Problem(`${file.name} is nothing that the page reads: expected ${offered()}.`);
    await kind.open(context, file);
    actions.say(panel, "file", null);
  } catch (error) {
    actions.say(panel, "file", error instanceof Error ? error.message : String(error));
  }
}

/** Files that are dropped anywhere. */
export function listenToDrops(context: Context): void {
  const { root, signal } = context;
  root.style.setProperty("--drop", JSON.stringify(`Drop ${offered()}`));
  const isFile = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
  const mark = (panel: Element | null) => {
    for (const each of root.querySelectorAll(".dropping")) each.classList.remove("dropping");
    panel?.classList.add("dropping");
  };
  const over = (event: DragEvent) => {
    if (!isFile(event)) return;
    event.preventDefault();
    mark(panelOf(event));
  };
  const drop = (event: DragEvent) => {
    mark(null);
    if (!isFile(event)) return;
    event.preventDefault();
    const panel = PANELS.find((name) => panelOf(event)?.classList.contains(name)) ?? "route";
    for (const file of event.dataTransfer!.files) void openFile(context, file, panel);
  };
  root.addEventListener("dragover", over, { signal });
  root.addEventListener("dragleave", () => mark(null), { signal });
  root.addEventListener("drop", drop, { signal });
}

const PANELS: readonly Panel[] = ["space", "material", "route", "recipe"];

function panelOf({ target }: DragEvent): Element | null {
  return (target as Element).closest(".panel");
}

function offered(): string {
  return KINDS.map(({ what, suffixes }) => `${what} (${suffixes.map((each) => `.${each}`).join(", ")})`).join(
    ", ",
  );
}

/** A measurement becomes a material of the library, and the stop that was chosen. */
async function addMeasurement({ client, options, store, actions }: Context, file: File): Promise<void> {
  if (!client.add || !options.restart)
    throw new Problem(`${file.name} is read by a server alone: start \`halfway view\`, and drop it there.`);
  actions.setWaiting({ text: `Reading ${file.name} …`, share: null, computed: true });
  try {
    const name = await client.add(file);
    const state = store.get();
    const stops = state.stops.toSpliced(state.slot, state.inserting ? 0 : 1, name);
    const t = state.slot / Math.max(stops.length - 1, 1);
    options.restart(toHash({ ...state, stops, t, point: null }));
  } finally {
    actions.setWaiting(null);
  }
}

/** A recipe is shown, and kept; a shortlist joins the one that is there. */
async function openRecipes({ store, actions }: Context, file: File): Promise<void> {
  const text = await file.text();
  const opened = fromText(text, file.name, store.get().library);
  actions.keep(...opened);
  if (!isShortlist(text)) actions.hold(opened[0]!);
}

/** A picture of light all around takes the place of the light. */
async function openLight({ lights, store }: Context, file: File): Promise<void> {
  lights.put(await readLight(file));
  store.set({ light: "own", ownLight: file.name, turn: 0 });
}

async function openMesh({ store, actions, tables }: Context, file: File): Promise<void> {
  const geometry = await readMesh(file);
  const unsaid = !isIsotropic(tables.grid) && !geometry.hasAttribute("uv");
  const level = `${file.name} has no texture coordinates, which say where a material's tangent points: it runs level, around the vertical.`;
  actions.say("material", "tangent", unsaid ? level : null);
  store.set({ mesh: { name: file.name, geometry }, shape: "mesh", orbit: HOME });
}
