// What stands in the light's way: the triangles of a mesh in boxes within boxes, as the card walks them (shadow.glsl).
//
// The boxes come in the order of a walk downwards from the outermost. Each says where the walk goes on when a ray misses it,
// so the card needs no stack: B. Smits, "Efficiency Issues for Ray Tracing", Journal of Graphics Tools 3(2), 1998.

import { type BufferGeometry, DataTexture, FloatType, RGBAFormat } from "three";
import { MeshBVH } from "three-mesh-bvh";

export interface Occluder {
  /** Two texels a box: low corner and where to go on; high corner and number of triangles. One with triangles says the first. */
  readonly boxes: DataTexture;
  readonly nBoxes: number;
  /** Three texels each: a corner, and the ways to the others. */
  readonly triangles: DataTexture;
}

/** A row has 2^11 texels: as many as every card takes. */
export const OCCLUDER_BITS = 11;
const WIDTH = 2 ** OCCLUDER_BITS;
const TRIANGLES_A_BOX = 4;

/** Of a mesh, whose triangles are put into another order. */
export function toOccluder(geometry: BufferGeometry): Occluder {
  const tree = new MeshBVH(geometry, { targetLeafSize: TRIANGLES_A_BOX });
  const boxes = flatten(tree);
  return { boxes: toTexture(boxes), nBoxes: boxes.length / 8, triangles: toTexture(corners(geometry)) };
}

export function disposeOccluder({ boxes, triangles }: Occluder): void {
  boxes.dispose();
  triangles.dispose();
}

function flatten(tree: MeshBVH): number[] {
  const boxes: number[] = [];
  /** Boxes that the walk is in, by depth. */
  const open: number[] = [];
  const close = (depth: number) => {
    for (const box of open.splice(depth)) boxes[8 * box + 3] = boxes.length / 8;
  };
  tree.traverse((depth, isLeaf, [x0, y0, z0, x1, y1, z1], first, count) => {
    close(depth);
    // The library says of an inner box in what direction it is divided.
    if (!isLeaf) open.push(boxes.length / 8);
    boxes.push(x0!, y0!, z0!, isLeaf ? first : 0, x1!, y1!, z1!, isLeaf ? count : 0);
  });
  close(0);
  return boxes;
}

function corners(geometry: BufferGeometry): Float32Array {
  const { index } = geometry;
  const { array } = geometry.getAttribute("position");
  const texels = new Float32Array(4 * index!.count);
  for (let triangle = 0; triangle < index!.count; triangle += 3) {
    const [a, b, c] = [0, 1, 2].map((i) => 3 * index!.getX(triangle + i)) as [number, number, number];
    for (let axis = 0; axis < 3; axis++) {
      const corner = array[a + axis]!;
      texels[4 * triangle + axis] = corner;
      texels[4 * triangle + 4 + axis] = array[b + axis]! - corner;
      texels[4 * triangle + 8 + axis] = array[c + axis]! - corner;
    }
  }
  return texels;
}

function toTexture(texels: ArrayLike<number>): DataTexture {
  const height = Math.max(1, Math.ceil(texels.length / 4 / WIDTH));
  const data = new Float32Array(4 * WIDTH * height);
  data.set(texels);
  const texture = new DataTexture(data, WIDTH, height, RGBAFormat, FloatType);
  texture.needsUpdate = true;
  return texture;
}
