import { expect, test } from "vitest";

import { compositeShader, environmentShader, pointsShader, sphereShader } from "../src/render/shaders";

/** What WebGL2 guarantees; software rasterisers have more and would hide it. */
const SAMPLERS = 16;
const VECTORS = 224;

test.each([
  ["points", pointsShader],
  ["environment", environmentShader],
  ["sphere", sphereShader],
  ["composite", compositeShader],
])("the %s shader keeps to what WebGL2 guarantees", (_, shader) => {
  expect((shader.match(/^uniform \w+ \w*sampler\w*/gm) ?? []).length).toBeLessThanOrEqual(SAMPLERS);
  const vectors = [...shader.matchAll(/^uniform vec\d \w+\[(\d+)\]/gm)].reduce(
    (sum, [, n]) => sum + Number(n),
    0,
  );
  expect(vectors).toBeLessThan(VECTORS / 2);
  expect(shader).not.toContain("@");
});
