// Which object is lit: the sphere, the teapot, or a mesh from a person's own file.

import type { Context } from "../../context";
import { el, segments } from "../../dom";
import { MESH_FILES, readMesh } from "../../render/meshes";
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
    if (chosen) void open(context, chosen);
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

/** Meshes that are dropped on the panel. */
export function openDropped(context: Context, panel: HTMLElement): void {
  const isFile = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
  panel.addEventListener("dragover", (event) => {
    if (!isFile(event)) return;
    event.preventDefault();
    panel.classList.add("dropping");
  });
  panel.addEventListener("dragleave", () => panel.classList.remove("dropping"));
  panel.addEventListener("drop", (event) => {
    panel.classList.remove("dropping");
    const file = event.dataTransfer?.files[0];
    if (!file) return;
    event.preventDefault();
    void open(context, file);
  });
}

async function open({ store }: Context, file: File): Promise<void> {
  try {
    const geometry = await readMesh(file);
    store.set({ mesh: { name: file.name, geometry }, shape: "mesh", orbit: HOME, problem: null });
  } catch (error) {
    store.set({ problem: error instanceof Error ? error.message : String(error) });
  }
}
