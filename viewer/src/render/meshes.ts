// A mesh from a person's file: triangles with normals, standing where the teapot stands.
//
// Files have y up, as `halfway render --mesh` reads them. Where a file has no normals, each vertex has the mean of its faces'. Its
// texture coordinates say where the tangent points; without them it runs level.

import { BufferGeometry, type Mesh, type Object3D } from "three";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import { PLYLoader } from "three/addons/loaders/PLYLoader.js";
import { mergeGeometries, mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";

import { Problem } from "../api/client";

export const MESH_FILES = ".ply,.obj";
const MAX_BYTES = 100e6;
const MAX_TRIANGLES = 2e6;
/** Of the sphere around it, and how high its middle is: as the teapot's. */
const RADIUS = 2.1;

export async function readMesh(file: File): Promise<BufferGeometry> {
  if (file.size > MAX_BYTES)
    throw new Problem(`${file.name} has ${millions(file.size)} MB: expected at most ${millions(MAX_BYTES)}.`);
  const kind = file.name.toLowerCase().split(".").at(-1);
  let geometry: BufferGeometry | null;
  if (kind === "ply") geometry = fromPly(await file.arrayBuffer(), file.name);
  else if (kind === "obj") geometry = fromObj(await file.text());
  else throw new Problem(`${file.name} is no mesh that the page reads: expected a .ply or .obj file.`);
  return placed(checked(geometry, file.name));
}

function fromPly(bytes: ArrayBuffer, name: string): BufferGeometry | null {
  let geometry: BufferGeometry;
  try {
    if (new TextDecoder().decode(bytes.slice(0, 3)) !== "ply") throw new Error();
    geometry = new PLYLoader().parse(bytes);
  } catch {
    throw new Problem(`${name} is not a PLY file, or is cut short: expected vertices and faces.`);
  }
  // Points alone have no index.
  return geometry.index === null ? null : geometry;
}

function fromObj(text: string): BufferGeometry | null {
  const parts: BufferGeometry[] = [];
  new OBJLoader().parse(text).traverse((object: Object3D) => {
    if ((object as Mesh).isMesh) parts.push((object as Mesh).geometry);
  });
  const common = USED.filter((name) => parts.every((part) => part.hasAttribute(name)));
  return parts.length ? mergeGeometries(parts.map((part) => only(part, common))) : null;
}

const USED = ["position", "normal", "uv"];

/** Those of these attributes that it has. */
function only(geometry: BufferGeometry, names: readonly string[]): BufferGeometry {
  const kept = new BufferGeometry().setIndex(geometry.index);
  for (const name of names)
    if (geometry.hasAttribute(name)) kept.setAttribute(name, geometry.getAttribute(name));
  return kept;
}

function checked(geometry: BufferGeometry | null, name: string): BufferGeometry {
  const position = geometry?.getAttribute("position");
  const nTriangles = ((geometry?.index ?? position)?.count ?? 0) / 3;
  if (!geometry || !position || nTriangles < 1)
    throw new Problem(
      `${name} has no triangles: expected a mesh. A cloud of points has no surface to light.`,
    );
  if (nTriangles > MAX_TRIANGLES)
    throw new Problem(
      `${name} has ${millions(nTriangles)} million triangles: expected at most ${millions(MAX_TRIANGLES)}.`,
    );
  if (!position.array.every(Number.isFinite))
    throw new Problem(`${name} has positions that are no numbers: expected finite ones.`);
  const nVertices = position.count;
  if (geometry.index?.array.some((i) => i >= nVertices))
    throw new Problem(`${name} has faces of vertices that it does not have: expected ${nVertices} at most.`);
  return geometry.hasAttribute("normal") ? only(geometry, USED) : smoothed(geometry);
}

/** With normals of the faces around each position, over the seams of texture coordinates too. */
function smoothed(geometry: BufferGeometry): BufferGeometry {
  const smooth = mergeVertices(only(geometry, ["position"]));
  smooth.computeVertexNormals();
  if (!geometry.hasAttribute("uv")) return smooth;
  const corners = smooth.toNonIndexed();
  const { uv } = (geometry.index ? only(geometry, ["position", "uv"]).toNonIndexed() : geometry).attributes;
  return corners.setAttribute("uv", uv!);
}

function placed(geometry: BufferGeometry): BufferGeometry {
  geometry.rotateX(Math.PI / 2);
  geometry.computeBoundingBox();
  const box = geometry.boundingBox!;
  const [x, y, z] = box.min.clone().add(box.max).multiplyScalar(-0.5).toArray();
  geometry.translate(x, y, z);
  geometry.computeBoundingSphere();
  const scale = RADIUS / Math.max(geometry.boundingSphere!.radius, 1e-30);
  return geometry.scale(scale, scale, scale);
}

function millions(n: number): string {
  return (n / 1e6).toFixed(n < 10e6 ? 1 : 0);
}
