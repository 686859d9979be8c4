// Which object is lit: the sphere, the teapot, or a mesh from a person's own file.

import type { Context } from "../../context";
import { el, segments } from "../../dom";
import { openFile } from "../../opening";
import { MESH_FILES } from "../../render/meshes";
import { HOME, type Shape } from "../../scene";

const SHAPES: readonly (readonly [Shape, string])[] = [
  ["sphere", "Sphere"],
  ["teapot", "Teapot"],
  ["mesh", "Mesh"],
];

export function shapeChoice(context: Context): HTMLElement {
  const { store } = context;
  const file = fileInput(context);
  const { element, mark } = segments("Object", SHAPES, (shape) => {
    const { mesh, shape: before } = store.get();
    if (shape === "mesh" && (mesh === null || before === "mesh")) file.click();
    else store.set({ shape, orbit: HOME });
  });
  const own = element.querySelector<HTMLElement>("[data-value=mesh]")!;
  store.watch(["shape", "mesh"], ({ shape, mesh }) => {
    mark(shape);
    own.title = `${mesh ? `${mesh.name}; again for another` : "Your own"}: a .ply or .obj file, or drop one here`;
  });
  element.append(file);
  return element;
}

function fileInput(context: Context): HTMLInputElement {
  const onchange = () => {
    const chosen = input.files?.[0];
    // The same file may be chosen again after it changed.
    input.value = "";
    if (chosen) void openFile(context, chosen, "material");
  };
  const input = el("input", {
    type: "file",
    accept: MESH_FILES,
    hidden: true,
    "aria-label": "Mesh file",
    onchange,
  });
  return input;
}
