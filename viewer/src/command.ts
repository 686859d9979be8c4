// What the page shows, as what the command line makes: `halfway route`, `mix` or `find`, and `halfway render`.

import { type Asked, HIGHLIGHT, written } from "./asked";
import { recipeAt } from "./route";
import type { State } from "./state";
import { fileName, materialName } from "./title";

type Shown = Pick<
  State,
  | "asked"
  | "held"
  | "kept"
  | "library"
  | "space"
  | "blend"
  | "pace"
  | "stops"
  | "t"
  | "point"
  | "atPoint"
  | "recipe"
  | "route"
  | "shape"
  | "mesh"
  | "light"
  | "exposure"
  | "grain"
>;

export function toCommand(shown: Shown): string {
  const name = materialName(shown);
  const file = `${name}.${suffixOf(shown)}`;
  if (shown.asked && shown.held) return `${find(shown, shown.asked, file)} && ${render(shown, file, name)}`;
  if (shown.held)
    return `halfway mix ${quoted(`${name}.json`)} -o ${quoted(file)} && ${render(shown, file, name)}`;
  if (shown.point !== null) return `${mix(shown, file)} && ${render(shown, file, name)}`;
  return `${route(shown, name)} && ${render(shown, name, name)}`;
}

/** Of a file that holds tables of the library. */
function suffixOf({ library }: Pick<Shown, "library">): string {
  return library.grid.some(({ angle }) => angle === "phi_h") ? "zarr" : "binary";
}

function mix({ library, point, ...where }: Shown, file: string): string {
  const at = `--point=${(point ?? []).join(",")} ${inSpace(where)}`;
  return `halfway mix ${quoted(library.address)} ${at} --clamp -o ${quoted(file)}`;
}

function route({ library, pace, stops, t, ...where }: Shown, folder: string): string {
  const way = `${stops.map(quoted).join(" ")} ${inSpace(where)} --pace ${pace} --t ${Number(t.toFixed(4))}`;
  return `halfway route ${quoted(library.address)} ${way} -o ${quoted(folder)}`;
}

function inSpace({ space, blend }: Pick<Shown, "space" | "blend">): string {
  return `--space ${space} --blend ${blend}`;
}

/** What makes the material that it is like comes before, where that is no file and none of the library. */
function find(shown: Shown, { like, set, loose }: Asked, file: string): string {
  const { library, held, kept, point, t } = shown;
  const wishes = Object.entries(set).map(([name, value]) => `--set ${quoted(`${name}=${written(value)}`)}`);
  if (loose) wishes.push(...HIGHLIGHT.map((name) => `--release ${name}`));
  const command = (what: string) =>
    `halfway find ${quoted(library.address)} --like ${quoted(what)} ${wishes.join(" ")} --blend ${held?.recipe.blend} --clamp -o ${quoted(file)}`;
  if (like !== null) {
    const own = kept.find(({ recipe }) => recipe === like)?.name ?? "recipe";
    return command(`${fileName(own)}.json`);
  }
  const near = `like.${suffixOf(shown)}`;
  if (point !== null) return `${mix(shown, near)} && ${command(near)}`;
  const [only, ...others] = shown.route ? recipeAt(shown.route, t) : [];
  if (only && others.length === 0) return command(only.name);
  return `${route(shown, "like")} && ${command("like/recipes.json:0")}`;
}

function render({ shape, mesh, light, exposure, grain }: Shown, what: string, name: string): string {
  // A sphere stands in the scene with the three lights; every other light is in their place.
  const scene = shape === "teapot" ? "teapot" : "spheres";
  const words = ["halfway render", quoted(what), "--scene", scene];
  if (light === "studio" && scene !== "teapot") words.push("--env studio");
  else if (light !== "studio" && light !== "points") words.push(`--env ${light}.exr`);
  if (shape === "mesh" && mesh) words.push("--mesh", quoted(mesh.name));
  if (grain !== 0) words.push("--turn", String(grain));
  if (exposure !== 0) words.push("--exposure", String(exposure));
  return `${words.join(" ")} -o ${quoted(`${name}.png`)}`;
}

/** One word for a shell. */
function quoted(text: string): string {
  return /^[\w.:/=-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}
