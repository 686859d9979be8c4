import { Vector3 } from "three";
import { expect, test } from "vitest";

import { only } from "../src/recipe";
import { components, principalAxes } from "../src/render/axes";
import { CoordinateMap, quantileScale } from "../src/render/maps";

test("the longest way of a cloud is its first axis", () => {
  const [along, across] = [new Vector3(1, 2, 2).normalize(), new Vector3(2, -2, 1).normalize()];
  const points = [-3, -1, 1, 3].flatMap((t) => [
    along.clone().multiplyScalar(t).addScaledVector(across, 0.5),
    along.clone().multiplyScalar(t).addScaledVector(across, -0.5),
  ]);
  const [first, second, third] = principalAxes(points);
  expect(Math.abs(first.dot(along))).toBeCloseTo(1, 10);
  expect(Math.abs(second.dot(across))).toBeCloseTo(1, 10);
  expect(Math.abs(third.dot(along))).toBeCloseTo(0, 10);
});

test("points on a line, or all in one, have three axes too", () => {
  for (const points of [
    [-1, 0, 1],
    [0, 0],
  ].map((all) => all.map((x) => new Vector3(x, 0, 0)))) {
    const axes = principalAxes(points);
    axes.forEach((axis, i) => {
      axes.forEach((other, j) => {
        expect(axis.dot(other)).toBeCloseTo(i === j ? 1 : 0, 10);
      });
    });
  }
});

test("a quantile scale is monotone and takes the ends to -1 and 1", () => {
  const values = [0, 1, 1.001, 1.002, 5, 1000, 1e6];
  const scale = quantileScale(values);
  expect(scale(0)).toBe(-1);
  expect(scale(1e6)).toBe(1);
  const dense = Array.from({ length: 2000 }, (_, i) => scale(10 ** (-2 + i / 250)));
  dense.slice(1).forEach((y, i) => {
    expect(y).toBeGreaterThanOrEqual(dense[i]!);
  });
});

test("a material's own point is where its mix is drawn", () => {
  const points = [
    [0, 5, 1],
    [2, 1, 7],
    [9, 3, 3],
    [4, 4, 400],
    [1, 8, 2],
  ];
  const names = points.map((_, i) => String(i));
  const map = new CoordinateMap(
    { name: "", channel: "all", axes: ["a", "b", "c"], points, edges: [] },
    names,
  );
  names.forEach((name, i) => {
    expect(map.pointOf(only(name)).distanceTo(map.points[i]!)).toBeLessThan(1e-12);
  });
});

test("principal components are the directions of most variance", () => {
  const vectors = [-2, -1, 0, 1, 2].flatMap((t) =>
    [-1, 1].map((s) => Float64Array.from([3 * t, 3 * t, s, 0])),
  );
  const [first, second] = components(vectors, 2);
  expect(first![0]).toBeCloseTo(Math.SQRT1_2, 8);
  expect(first![1]).toBeCloseTo(Math.SQRT1_2, 8);
  expect(second![2]).toBeCloseTo(1, 8);
});
