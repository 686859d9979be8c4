// Directional albedo, as `halfway.brdf.directional_albedo` computes it: how much of the light from one direction is reflected.
//
//     a(theta_i) = integral of f_r(wi, wo) cos(theta_o) over the hemisphere of wo
//
// Midpoint rule over half vectors with square-root spaced theta_h; dwo = 4 (wi . h) dh.

import type { Direction } from "./halfdiff";
import { evaluate, type Rgb, type Table } from "./table";

/** Reflected share of the light from `thetaI` (radians); unmeasured values count as 0. */
export function directionalAlbedo(table: Table, thetaI: number, nThetaH = 360, nPhiH = 60): Rgb {
  const wi: Direction = [Math.sin(thetaI), 0, Math.cos(thetaI)];
  const edge = (i: number) => (Math.PI / 2) * (i / nThetaH) ** 2;
  const sum: [number, number, number] = [0, 0, 0];
  for (let i = 0; i < nThetaH; i++) {
    const theta = edge(i + 0.5);
    const [sine, z] = [Math.sin(theta), Math.cos(theta)];
    const solidAngle = ((Math.cos(edge(i)) - Math.cos(edge(i + 1))) * 2 * Math.PI) / nPhiH;
    for (let j = 0; j < nPhiH; j++) {
      const phi = (2 * Math.PI * (j + 0.5)) / nPhiH;
      const [x, y] = [sine * Math.cos(phi), sine * Math.sin(phi)];
      const cosine = x * wi[0] + z * wi[2];
      const cosineO = 2 * cosine * z - wi[2];
      if (cosine <= 0 || cosineO <= 0) continue;
      const [r, g, b] = evaluate(table, wi, [2 * cosine * x - wi[0], 2 * cosine * y, cosineO]);
      const weight = 4 * cosine * solidAngle * cosineO;
      sum[0] += weight * r;
      sum[1] += weight * g;
      sum[2] += weight * b;
    }
  }
  return sum;
}
