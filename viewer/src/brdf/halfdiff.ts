// Half and difference angles of a pair of directions: the same as `halfway.halfdiff`, for one pair.
//
//     h = (wi + wo) / |wi + wo|              theta_h is its polar angle
//     d = R_y(-theta_h) R_z(-phi_h) wi       theta_d, phi_d are its polar angles
//
// S. Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation", 1998, section 3.

import { dot } from "../numbers";

/** Local frame of the surface: normal +z, tangent +x. */
export type Direction = readonly [number, number, number];

export function toDirection(theta: number, phi: number): Direction {
  return [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
}

/** The direction that is to the other side of the half vector h: 2 (w . h) h - w. */
export function reflected(w: Direction, h: Direction): Direction {
  const twice = 2 * dot(w, h);
  return [twice * h[0] - w[0], twice * h[1] - w[1], twice * h[2] - w[2]];
}

export interface HalfDiff {
  readonly thetaH: number;
  readonly phiH: number;
  readonly thetaD: number;
  readonly phiD: number;
}

export function toHalfDiff(wi: Direction, wo: Direction): HalfDiff {
  const hx = wi[0] + wo[0];
  const hy = wi[1] + wo[1];
  const hz = wi[2] + wo[2];
  // atan2, never acos: near the pole acos loses half the digits.
  const thetaH = Math.atan2(Math.hypot(hx, hy), hz);
  const phiH = Math.atan2(hy, hx);
  const c = Math.cos(phiH);
  const s = Math.sin(phiH);
  const x = c * wi[0] + s * wi[1];
  const y = c * wi[1] - s * wi[0];
  const ct = Math.cos(thetaH);
  const st = Math.sin(thetaH);
  const dx = ct * x - st * wi[2];
  const dz = st * x + ct * wi[2];
  return { thetaH, phiH, thetaD: Math.atan2(Math.hypot(dx, y), dz), phiD: Math.atan2(y, dx) };
}
