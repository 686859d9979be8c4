import { expect, test } from "vitest";

import { toDrawable } from "../src/brdf/grid";
import { compositeShader, environmentShader, pointsShader, sphereShader } from "../src/render/shaders";

/** What WebGL2 guarantees; software rasterisers have more and would hide it. */
const SAMPLERS = 16;
const VECTORS = 224;

const axis = (angle: string, stop: number, power = 1) => ({ angle, size: 4, stop, power, periodic: false });
const AXES = [axis("theta_h", Math.PI / 2, 2), axis("theta_d", Math.PI / 2), axis("phi_d", Math.PI)];
const isotropic = toDrawable(AXES);
const anisotropic = toDrawable([AXES[0]!, axis("phi_h", Math.PI), ...AXES.slice(1)]);

test.each([
  ["points", pointsShader(isotropic)],
  ["environment", environmentShader(isotropic)],
  ["anisotropic points", pointsShader(anisotropic)],
  ["anisotropic environment", environmentShader(anisotropic)],
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
