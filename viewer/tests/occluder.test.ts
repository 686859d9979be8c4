import { Ray, TorusKnotGeometry, Triangle, Vector3 } from "three";
import { expect, test } from "vitest";

import { type Occluder, toOccluder } from "../src/render/occluder";

const RAYS = 400;

/** The texels of a list. */
function texels(texture: Occluder["boxes"]): (i: number) => Vector3 & { w: number } {
  const data = texture.image.data as Float32Array;
  return (i) => Object.assign(new Vector3().fromArray(data, 4 * i), { w: data[4 * i + 3]! });
}

/** How the card walks (shadow.glsl), here to a list of the triangles that it looks at. */
function looked(at: Ray, { boxes, nBoxes }: Occluder): Set<number> {
  const box = texels(boxes);
  const found = new Set<number>();
  let i = 0;
  while (i < nBoxes) {
    const [low, high] = [box(2 * i), box(2 * i + 1)];
    const met = at.intersectsBox({ min: low, max: high } as never);
    for (let k = 0; met && k < high.w; k++) found.add(low.w + k);
    i = met || high.w > 0 ? i + 1 : low.w;
  }
  return found;
}

/** Even in solid angle, the same ones every time. */
function direction(i: number): Vector3 {
  const z = 1 - (2 * i + 1) / RAYS;
  return new Vector3().setFromCylindricalCoords(Math.sqrt(1 - z * z), 2.399963 * i, z);
}

test("a walk through the boxes comes to every triangle that a ray crosses, and to few others", () => {
  const geometry = new TorusKnotGeometry(1, 0.4, 60, 12);
  const occluder = toOccluder(geometry);
  const corner = texels(occluder.triangles);
  const n = geometry.index!.count / 3;
  const triangles = Array.from({ length: n }, (_, k) => {
    const [a, ab, ac] = [corner(3 * k), corner(3 * k + 1), corner(3 * k + 2)];
    return new Triangle(a, ab.add(a), ac.add(a));
  });
  let [crossings, looks] = [0, 0];
  for (let i = 0; i < RAYS; i++) {
    const ray = new Ray(direction(RAYS - 1 - i).multiplyScalar(0.3), direction(i));
    const found = looked(ray, occluder);
    looks += found.size;
    triangles.forEach(({ a, b, c }, k) => {
      if (ray.intersectTriangle(a, b, c, false, new Vector3()) === null) return;
      crossings++;
      expect(found).toContain(k);
    });
  }
  expect(crossings).toBeGreaterThan(RAYS / 2);
  expect(looks / RAYS).toBeLessThan(0.1 * n);
});

test("the card is given the triangles that are drawn", () => {
  const geometry = new TorusKnotGeometry(1, 0.4, 20, 8);
  const area = (a: Vector3, b: Vector3) => a.cross(b).length() / 2;
  const position = geometry.getAttribute("position");
  const { index } = geometry;
  const drawn = (i: number) => new Vector3().fromBufferAttribute(position, index!.getX(i));
  const nTriangles = index!.count / 3;
  const each = (f: (i: number) => number) =>
    Array.from({ length: nTriangles }, (_, i) => f(3 * i)).reduce((a, b) => a + b, 0);
  const before = each((i) => area(drawn(i + 1).sub(drawn(i)), drawn(i + 2).sub(drawn(i))));
  const { triangles } = toOccluder(geometry);
  const texel = texels(triangles);
  expect(each((i) => area(texel(i + 1), texel(i + 2)))).toBeCloseTo(before, 5);
});
