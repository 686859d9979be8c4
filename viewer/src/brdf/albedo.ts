// Directional albedo, as `halfway.brdf.directional_albedo` computes it: how much of the light from one direction is reflected.
//
//     a(theta_i) = integral of f_r(wi, wo) cos(theta_o) over the hemisphere of wo
//
// Midpoint rule over half vectors with square-root spaced theta_h; dwo = 4 (wi . h) dh.

import { neighbours, toPosition } from "./grid";
import { interpolate, type Rgb, type Table } from "./table";

/** Reflected share of the light from `thetaI` (radians); unmeasured values count as 0. */
export function directionalAlbedo(table: Table, thetaI: number, nThetaH = 360, nPhiH = 60): Rgb {
  const [axisH, axisD, axisP] = table.grid;
  const [across, up] = [Math.sin(thetaI), Math.cos(thetaI)];
  const edge = (i: number) => (Math.PI / 2) * (i / nThetaH) ** 2;
  const turns = Array.from({ length: nPhiH }, (_, j) => (2 * Math.PI * (j + 0.5)) / nPhiH);
  const [cosines, sines] = [Float64Array.from(turns, Math.cos), Float64Array.from(turns, Math.sin)];
  const sum: [number, number, number] = [0, 0, 0];
  for (let i = 0; i < nThetaH; i++) {
    const theta = edge(i + 0.5);
    const [sine, z] = [Math.sin(theta), Math.cos(theta)];
    const h = neighbours(axisH, toPosition(axisH, theta));
    const solidAngle = ((Math.cos(edge(i)) - Math.cos(edge(i + 1))) * 2 * Math.PI) / nPhiH;
    for (let j = 0; j < nPhiH; j++) {
      const [x, y] = [cosines[j]!, sines[j]!];
      const cosine = sine * x * across + z * up;
      const cosineO = 2 * cosine * z - up;
      if (cosine <= 0 || cosineO <= 0) continue;
      // Of wi, in the frame of the half vector (`toHalfDiff`, whose half vector is not known before).
      const phiD = Math.atan2(-y * across, z * x * across - sine * up);
      const d = neighbours(axisD, toPosition(axisD, Math.acos(Math.min(cosine, 1))));
      const p = neighbours(axisP, toPosition(axisP, phiD));
      const [r, g, b] = interpolate(table, h, d, p);
      const weight = 4 * cosine * solidAngle * cosineO;
      sum[0] += weight * r;
      sum[1] += weight * g;
      sum[2] += weight * b;
    }
  }
  return sum;
}
