// What the page shows, as what the command line makes: `halfway route` or `halfway mix`, and `halfway render`.

import type { State } from "./state";
import { materialName } from "./title";

type Shown = Pick<
  State,
  | "held"
  | "library"
  | "space"
  | "blend"
  | "pace"
  | "stops"
  | "t"
  | "point"
  | "atPoint"
  | "recipe"
  | "shape"
  | "mesh"
  | "light"
  | "exposure"
  | "grain"
>;

export function toCommand(shown: Shown): string {
  const name = materialName(shown);
  const { held, library, space, blend, pace, stops, t, point } = shown;
  const where = `--space ${space} --blend ${blend}`;
  const source = quoted(library.address);
  const file = `${name}.${library.grid.some(({ angle }) => angle === "phi_h") ? "zarr" : "binary"}`;
  if (held) return `halfway mix ${quoted(`${name}.json`)} -o ${quoted(file)} && ${render(shown, file, name)}`;
  if (point !== null) {
    const mix = `halfway mix ${source} --point=${point.join(",")} ${where} --clamp -o ${quoted(file)}`;
    return `${mix} && ${render(shown, file, name)}`;
  }
  const way = `${stops.map(quoted).join(" ")} ${where} --pace ${pace} --t ${Number(t.toFixed(4))}`;
  return `halfway route ${source} ${way} -o ${quoted(name)} && ${render(shown, name, name)}`;
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
