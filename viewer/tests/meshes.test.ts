import { expect, test } from "vitest";

import { readMesh } from "../src/render/meshes";

const PYRAMID = `v 0 2 0
v 1 0 1
v 1 0 -1
v -1 0 -1
v -1 0 1
f 1 2 3
f 1 3 4
f 1 4 5
f 1 5 2
f 5 4 3 2
`;
const TRIANGLE =
  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";

const read = (name: string, text: string) => readMesh(new File([text], name));

test("a mesh stands upright around the origin, with normals of unit length", async () => {
  const geometry = await read("pyramid.obj", PYRAMID);
  geometry.computeBoundingBox();
  const { min, max } = geometry.boundingBox!;
  // y of the file is up, and becomes z.
  expect(max.z - min.z).toBeCloseTo(max.x - min.x, 5);
  for (const axis of ["x", "y", "z"] as const) expect(min[axis] + max[axis]).toBeCloseTo(0, 5);
  const [position, normal] = [geometry.getAttribute("position"), geometry.getAttribute("normal")];
  for (let i = 0; i < position.count; i++) {
    expect(Math.hypot(normal.getX(i), normal.getY(i), normal.getZ(i))).toBeCloseTo(1, 5);
    // Of a convex body, they point outwards.
    const outwards =
      normal.getX(i) * position.getX(i) +
      normal.getY(i) * position.getY(i) +
      normal.getZ(i) * position.getZ(i);
    expect(outwards).toBeGreaterThan(0);
  }
});

test("a PLY file is read too", async () => {
  const faces =
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const geometry = await read("triangle.ply", TRIANGLE + faces);
  expect(geometry.getAttribute("position").count).toBe(3);
  expect(geometry.getAttribute("normal").getY(0)).toBeCloseTo(-1, 5);
});

test.each([
  ["statue.stl", "solid", "statue.stl is no mesh that the page reads: expected a .ply or .obj file."],
  ["empty.obj", "# nothing\n", "empty.obj has no triangles"],
  ["points.ply", `${TRIANGLE}end_header\n0 0 0\n1 0 0\n0 1 0\n`, "points.ply has no triangles"],
  ["text.ply", "hello", "text.ply is not a PLY file"],
  ["nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "nan.obj has positions that are no numbers"],
])("what is wrong with %s is said in one line", async (name, text, said) => {
  await expect(read(name, text)).rejects.toThrow(said);
});

test("a file that is too large is not read", async () => {
  const file = { name: "huge.obj", size: 200e6 } as File;
  await expect(readMesh(file)).rejects.toThrow("huge.obj has 200 MB: expected at most 100.");
});

const SEAM = `ply
format ascii 1.0
element vertex 6
property float x
property float y
property float z
property float u
property float v
element face 2
property list uchar int vertex_indices
end_header
0 0 0 0 0
1 0 0 1 0
1 1 0 1 1
0 0 0 0 1
1 1 0 0 0
0 1 1 1 0
3 0 1 2
3 3 4 5
`;

test("texture coordinates stay with their corners, and a seam of them is no edge", async () => {
  const geometry = await read("seam.ply", SEAM);
  const [uv, normal] = [geometry.getAttribute("uv"), geometry.getAttribute("normal")];
  const corners = Array.from({ length: 6 }, (_, i) => `${uv.getX(i)} ${uv.getY(i)}`);
  expect(corners).toEqual(["0 0", "1 0", "1 1", "0 1", "0 0", "1 0"]);
  // Both triangles have the first vertex.
  for (const axis of [0, 1, 2]) expect(normal.array[axis]).toBeCloseTo(normal.array[9 + axis]!, 6);
});

test("a mesh without texture coordinates has none", async () => {
  expect((await read("pyramid.obj", PYRAMID)).hasAttribute("uv")).toBe(false);
});
