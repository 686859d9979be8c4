// What the code keeps to: one home for each piece of physics, and data that flow one way.

import { readdirSync, readFileSync } from "node:fs";
import { dirname, join, relative, resolve } from "node:path";
import { expect, test } from "vitest";

const SRC = resolve(import.meta.dirname, "../src");
const FILES = readdirSync(SRC, { recursive: true, encoding: "utf8" }).filter((file) =>
  /\.(ts|glsl)$/.test(file),
);

const TEXTS = new Map(FILES.map((file) => [file, readFileSync(join(SRC, file), "utf8")]));

test.each([
  ["the sRGB curve", /1\.055/, ["colour.ts", "render/glsl/srgb.glsl"]],
  ["the inverse of the sRGB curve", /0\.04045/, ["colour.ts"]],
  [
    "reflection about a half vector",
    /2(\.0)? \* dot\(w, h\)/,
    ["brdf/halfdiff.ts", "render/glsl/halfdiff.glsl"],
  ],
  ["the solid angle of a ring", /Math\.sin\(to \/ 2\) \*\* 2/, ["brdf/lobe.ts"]],
  ["half floats", /fromHalfFloat/, ["brdf/half.ts"]],
])("%s has one home in each language", (_, pattern, homes) => {
  expect(FILES.filter((file) => pattern.test(TEXTS.get(file)!)).sort()).toEqual(homes);
});

/** What a file imports, by its path. */
function imported(file: string): string[] {
  const paths = [...TEXTS.get(file)!.matchAll(/from "(\.[^"]*)"/g)].map(([, path]) => path!);
  return paths.map((path) => `${relative(SRC, resolve(SRC, dirname(file), path)).replaceAll("\\", "/")}.ts`);
}

test.each([
  ["state.ts", /^(render|panels|dom|context)/],
  ["brdf/", /^(render|panels|state|dom|context)/],
  ["api/", /^(render|panels|state|dom|context)/],
  ["render/", /^(panels|state|context|follow)/],
  ["panels/", /^(mount|main|widget|follow)/],
])("%s knows nothing of what is above it", (folder, above) => {
  for (const file of FILES.filter((name) => name.startsWith(folder) && name.endsWith(".ts")))
    expect(
      imported(file).filter((name) => above.test(name)),
      file,
    ).toEqual([]);
});

test("things have names that say what they are", () => {
  for (const [file, text] of TEXTS) {
    const code = text.replaceAll(/\/\*[\s\S]*?\*\/|\/\/.*|"[^"\n]*"|`[^`]*`/g, "");
    expect(code.match(/\b(found|told|made|[pP]laces?)\b/g) ?? [], file).toEqual([]);
  }
});
