import { expect, test, vi } from "vitest";
import type { Pictures } from "../src/api/client";
import { PLAIN } from "../src/blend";
import { toSrgb } from "../src/colour";
import { Appearance } from "../src/render/appearance";
import { addTo, toScreen } from "../src/rgbe";
import { Thumbnails } from "../src/thumbnails";

const SIZE = 24;
const NAMES = ["a", "b", "c"];
const HALVES = [
  { name: "a", weight: [0.5, 0.5, 0.5] as const },
  { name: "b", weight: [0.5, 0.5, 0.5] as const },
];

/** Pictures of one colour each: bytes that share an exponent. */
function flat(...pixels: readonly (readonly number[])[]): Pictures {
  const bytes = Uint8Array.from(
    pixels.flatMap((pixel) =>
      Array(SIZE * SIZE)
        .fill(pixel)
        .flat(),
    ),
  );
  return { bytes, shape: [pixels.length, SIZE, SIZE, 4] };
}

function filled(make: (recipes: readonly unknown[]) => Promise<Pictures>, gone = new AbortController()) {
  const thumbnails = new Thumbnails(NAMES, "small", make, gone.signal);
  thumbnails.fill(flat([255, 0, 0, 128], [0, 255, 0, 128], [0, 0, 255, 128]));
  return thumbnails;
}

test("a picture of bytes and exponents is as a screen shows its values, and mixes beyond white", () => {
  // 200 x 2^(130 - 136) is 3.125: a mix of a quarter of it is not white.
  const glint = Uint8Array.of(200, 100, 0, 130, 7, 7, 7, 0);
  expect([...toScreen(glint)]).toEqual([255, 255, 0, 255, 0, 0, 0, 0]);
  const sum = new Float32Array(8);
  addTo(sum, glint, [0.25, 0.25, 1]);
  expect([...sum]).toEqual([0.78125, 0.390625, 0, 1, 0, 0, 0, 0]);
  for (const value of [1, 90, 255]) {
    const [shown] = toScreen(Uint8Array.of(value, 0, 0, 127));
    expect(Math.abs(shown! - 255 * toSrgb(value / 512))).toBeLessThanOrEqual(0.6);
  }
});

test("pictures of mixes that do not come are said, and asked for again", async () => {
  vi.useFakeTimers();
  const make = vi
    .fn()
    .mockRejectedValueOnce(new Error("the disk is full"))
    .mockResolvedValue(flat([10, 20, 30, 128]));
  const thumbnails = filled(make);
  const said: (string | null)[] = [];
  thumbnails.onProblem = (problem) => said.push(problem);
  const draw = vi.fn(() => thumbnails.blocks(HALVES, 1, { blend: "lobes" }, draw));
  draw();
  await vi.advanceTimersByTimeAsync(0);
  expect(said).toEqual([expect.stringContaining("the disk is full")]);
  // Meanwhile nobody asks, and the sum of the materials' pictures stands in.
  expect(draw()[0]).toBeGreaterThan(0.4);
  expect(make).toHaveBeenCalledTimes(1);
  await vi.advanceTimersByTimeAsync(5000);
  expect(make).toHaveBeenCalledTimes(2);
  expect(said.at(-1)).toBeNull();
  expect(draw()[0]).toBeCloseTo(10 / 256, 6);
  vi.useRealTimers();
});

test("a page that is gone asks no more", async () => {
  vi.useFakeTimers();
  const gone = new AbortController();
  const make = vi.fn().mockRejectedValue(new Error("no"));
  const thumbnails = filled(make, gone);
  const draw = () => void thumbnails.blocks(HALVES, 1, { blend: "lobes" }, draw);
  draw();
  await vi.advanceTimersByTimeAsync(0);
  gone.abort();
  await vi.advanceTimersByTimeAsync(100_000);
  expect(make).toHaveBeenCalledTimes(1);
  vi.useRealTimers();
});

test("among looks a mix stands where its picture is, in its own blend", async () => {
  // By this blend half of a and half of b looks like c.
  const thumbnails = filled(async (recipes) => flat(...recipes.map(() => [0, 0, 255, 128])));
  const map = new Appearance(NAMES, thumbnails);
  const linear = map.pointOf(HALVES, PLAIN, () => {});
  const point = await new Promise((resolve) => {
    map.pointOf(HALVES, { blend: "lobes" }, () => resolve(map.pointOf(HALVES, { blend: "lobes" }, () => {})));
  });
  expect(map.points[2]!.distanceTo(point as typeof linear)).toBeLessThan(1e-6);
  expect(map.points[2]!.distanceTo(linear)).toBeGreaterThan(0.5);
});
