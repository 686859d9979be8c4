import { DataUtils } from "three";
import { expect, test } from "vitest";

import type { Axis } from "../src/api/schema";
import { directionalAlbedo } from "../src/brdf/albedo";
import { isIsotropic, neighbours, toAngle, toDrawable, toPosition } from "../src/brdf/grid";
import { HALF } from "../src/brdf/half";
import { type Direction, toHalfDiff } from "../src/brdf/halfdiff";
import { lobe } from "../src/brdf/lobe";
import { evaluate, sample, type Table } from "../src/brdf/table";
import { NODES } from "../src/panels/brdf/albedo";
import { inversion } from "../src/render/chances";
import { golden } from "./golden";

const ROUNDING = 1e-9;

interface Lookup {
  grid: Axis[];
  scale: [number, number, number];
  halfs: string;
  wi: Direction[];
  wo: Direction[];
  values: [number, number, number][];
}

function goldenTable(file = "lookup"): Table {
  const { grid, scale, halfs } = golden<Lookup>(file);
  const bytes = Uint8Array.from(Buffer.from(halfs, "base64"));
  return { name: "golden", grid: toDrawable(grid), scale, halfs: new Uint16Array(bytes.buffer) };
}

test("half and difference angles are Python's, near the pole too", () => {
  for (const { wi, wo, angles } of golden<{ wi: Direction; wo: Direction; angles: number[] }[]>("halfdiff")) {
    const { thetaH, phiH, thetaD, phiD } = toHalfDiff(wi, wo);
    [thetaH, phiH, thetaD, phiD].forEach((angle, i) => {
      expect(Math.abs(angle - angles[i]!)).toBeLessThan(ROUNDING);
    });
  }
});

test("positions on the grid are Python's", () => {
  for (const { axis, angle, position } of golden<{ axis: Axis; angle: number; position: number }[]>("grid")) {
    expect(Math.abs(toPosition(axis, angle) - position)).toBeLessThan(ROUNDING * axis.size);
  }
});

test("an angle comes back from its position", () => {
  const axis: Axis = { angle: "theta_h", size: 90, stop: Math.PI / 2, power: 2, periodic: false };
  for (const position of [0, 0.5, 17.25, 90])
    expect(toPosition(axis, toAngle(axis, position))).toBeCloseTo(position, 10);
});

test("outer half cells clamp, and a periodic axis wraps", () => {
  const clamped: Axis = { angle: "theta_d", size: 4, stop: 1, power: 1, periodic: false };
  const wrapped: Axis = { ...clamped, periodic: true };
  expect(neighbours(clamped, 0.25)).toEqual([0, 0, 0.75]);
  expect(neighbours(clamped, 3.75)).toEqual([3, 3, 0.25]);
  expect(neighbours(wrapped, 0.25)).toEqual([3, 0, 0.75]);
  expect(neighbours(wrapped, 3.75)).toEqual([3, 0, 0.25]);
});

test.each(["lookup", "lookup_with_phi_h"])(
  "a %s is Python's, unmeasured corners and scales included",
  (file) => {
    const table = goldenTable(file);
    const { wi, wo, values } = golden<Lookup>(file);
    const largest = Math.max(...values.flat());
    values.forEach((value, i) => {
      evaluate(table, wi[i]!, wo[i]!).forEach((x, c) => {
        expect(Math.abs(x - value[c]!)).toBeLessThan(ROUNDING * largest);
      });
    });
  },
);

test("an unmeasured sample is null", () => {
  expect(sample(goldenTable(), 1, 0, 1, 2)).toBeNull();
  expect(sample(goldenTable("lookup_with_phi_h"), 1, 3, 1, 2)).toBeNull();
});

test("a table without phi_h has one cell of it; other angles are not known", () => {
  const { grid } = golden<Lookup>("lookup_with_phi_h");
  expect(isIsotropic(toDrawable(grid))).toBe(false);
  expect(isIsotropic(goldenTable().grid)).toBe(true);
  expect(() => toDrawable(grid.slice(0, 2))).toThrow(
    "grid is over theta_h, phi_h: the explorer draws theta_h",
  );
});

test("half floats have their values", () => {
  expect([0x0000, 0x3c00, 0xc000, 0x7bff, 0x0001, 0x7c00].map((bits) => HALF[bits])).toEqual([
    0,
    1,
    -2,
    65504,
    2 ** -24,
    Infinity,
  ]);
});

test("inverting the running sum gives every cell its chance, in order", () => {
  const mass = Float64Array.of(0.1, 0.5, 0, 3, 0.4);
  const { upTo, first, chance } = inversion(mass);
  const n = 4000;
  const drawn = new Float64Array(mass.length);
  let last = 0;
  for (let k = 0; k < n; k++) {
    const u = (k + 0.5) / n;
    let cell = first[Math.floor(u * mass.length)]!;
    while (upTo[cell]! <= u) cell++;
    expect(cell).toBeGreaterThanOrEqual(last);
    last = cell;
    drawn[cell]! += 1 / n;
  }
  mass.forEach((m, i) => {
    expect(chance[i]).toBeCloseTo(m / 4, 6);
    expect(Math.abs(drawn[i]! - m / 4)).toBeLessThanOrEqual(1.01 / n);
  });
});

test.each(["lookup", "lookup_with_phi_h"])("the lobe of a %s is a density over half vectors", (file) => {
  const { mass, ofThetaH, density } = lobe(goldenTable(file));
  const [axis, { size }] = goldenTable(file).grid;
  const total = density.reduce((sum, value, i) => {
    const [from, to] = [toAngle(axis, i), toAngle(axis, i + 1)];
    return sum + value * 2 * Math.PI * (Math.cos(from) - Math.cos(to));
  }, 0);
  expect(total).toBeCloseTo(1, 9);
  expect(mass.reduce((a, b) => a + b, 0)).toBeCloseTo(1, 9);
  ofThetaH.forEach((chance, i) => {
    expect(mass.subarray(i * size, (i + 1) * size).reduce((a, b) => a + b, 0)).toBeCloseTo(chance, 9);
  });
});

test.each(["", "_with_phi_h"])("the directional albedo%s is Python's", (kind) => {
  const { n_theta_h, n_phi_h, theta_i, phi_i, values } = golden<{
    n_theta_h: number;
    n_phi_h: number;
    theta_i: number[];
    phi_i: number;
    values: [number, number, number][];
  }>(`albedo${kind}`);
  theta_i.forEach((angle, i) => {
    const albedo = directionalAlbedo(goldenTable(`lookup${kind}`), angle, phi_i, n_theta_h, n_phi_h);
    albedo.forEach((x, c) => {
      expect(Math.abs(x / values[i]![c]! - 1)).toBeLessThan(1e-6);
    });
  });
});

/** A lobe of the ABC model, (1 + B (1 - cos theta_h))^-C, that rises to grazing angles, on the angles of the MERL grid. */
function lobeTable(b: number, c: number): Table {
  const axis = (angle: string, size: number, power: number): Axis => ({
    angle,
    size,
    stop: angle === "phi_d" ? Math.PI : Math.PI / 2,
    power,
    periodic: angle === "phi_d",
  });
  const grid = toDrawable([axis("theta_h", 90, 2), axis("theta_d", 90, 1), axis("phi_d", 1, 1)]);
  const halfs = new Uint16Array(4 * 90 * 90).fill(DataUtils.toHalfFloat(1));
  for (let h = 0; h < 90; h++) {
    for (let d = 0; d < 90; d++) {
      const shape = (1 + 2 * b * Math.sin(toAngle(grid[0], h + 0.5) / 2) ** 2) ** -c;
      const fresnel = 0.1 + 0.9 * (1 - Math.cos(toAngle(grid[2], d + 0.5))) ** 5;
      halfs.fill(
        DataUtils.toHalfFloat(0.001 + 900 * shape * fresnel),
        4 * (90 * h + d),
        4 * (90 * h + d) + 3,
      );
    }
  }
  return { name: "lobe", grid, halfs, scale: [1, 1, 1] };
}

// B and C of J. Low and others (SIGGRAPH 2012, as halfway.models has them).
test.each([
  ["chrome", 64661, 1.905],
  ["gold-metallic-paint", 53.7, 1.512],
])("the plotted albedo of a lobe like that of %s is near the converged integral", (_, b, c) => {
  const table = lobeTable(b, c);
  for (const degrees of [0, 30, 60, 80, 88]) {
    const [plotted, python, converged] = ([NODES, [360, 60], [1440, 240]] as const).map(
      ([nThetaH, nPhiH]) => directionalAlbedo(table, (degrees * Math.PI) / 180, 0, nThetaH, nPhiH)[0],
    );
    // Measured: .07 % at 88 degrees, below .001 % elsewhere.
    expect(Math.abs(plotted! / python! - 1)).toBeLessThan(0.001);
    // Measured: .14 %, the same as Python's.
    expect(Math.abs(plotted! / converged! - 1)).toBeLessThan(0.002);
  }
});
