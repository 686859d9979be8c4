// Where an angle is on its axis, as GLSL made of the axis: `thetaHShare(angle)` in [0, 1], and `thetaHAngle(share)` back.

import type { Axis } from "../api/schema";
import { type DrawableGrid, isIsotropic } from "../brdf/grid";

/** The functions of all axes; `TURNS` is defined where tables depend on phi_h. */
export function addressing(grid: DrawableGrid): string {
  const turns = isIsotropic(grid) ? "" : "#define TURNS\n";
  return turns + grid.map(ofAxis).join("");
}

function ofAxis({ angle, stop, power }: Axis): string {
  const name = angle.replace(/_(.)/, (_, letter: string) => letter.toUpperCase());
  const even = `angle * ${float(1 / stop)}`;
  const share = power === 1 ? even : power === 2 ? `sqrt(${even})` : `pow(${even}, ${float(1 / power)})`;
  const whole = Array.from({ length: power }, () => "share").join(" * ");
  return `float ${name}Share(float angle) { return ${share}; }
float ${name}Angle(float share) { return ${float(stop)} * ${whole}; }
`;
}

function float(x: number): string {
  return x.toFixed(9);
}
