// Directional albedo, as `halfway.brdf.directional_albedo` computes it: how much of the light from one direction is reflected.
//
//     a(theta_i, phi_i) = integral of f_r(wi, wo) cos(theta_o) over the hemisphere of wo
//
// Midpoint rule over half vectors with square-root spaced theta_h; dwo = 4 (wi . h) dh.

import { dot } from "../numbers";
import { reflected, toDirection } from "./halfdiff";
import { solidAngle } from "./lobe";
import { evaluate, type Rgb, type Table } from "./table";

/** Reflected share of the light from `thetaI` and `phiI` (radians); unmeasured values count as 0. */
export function directionalAlbedo(table: Table, thetaI: number, phiI = 0, nThetaH = 360, nPhiH = 60): Rgb {
  const wi = toDirection(thetaI, phiI);
  const edge = (i: number) => (Math.PI / 2) * (i / nThetaH) ** 2;
  const turns = Array.from({ length: nPhiH }, (_, j) => phiI + (2 * Math.PI * (j + 0.5)) / nPhiH);
  const sum: [number, number, number] = [0, 0, 0];
  for (let i = 0; i < nThetaH; i++) {
    const theta = edge(i + 0.5);
    const dh = solidAngle(edge(i), edge(i + 1)) / nPhiH;
    for (const phi of turns) {
      const h = toDirection(theta, phi);
      const wo = reflected(wi, h);
      const cosine = dot(wi, h);
      if (cosine <= 0 || wo[2] <= 0) continue;
      const value = evaluate(table, wi, wo);
      for (let c = 0; c < 3; c++) sum[c]! += 4 * cosine * dh * wo[2] * value[c]!;
    }
  }
  return sum;
}
