import { DataUtils } from "three";

/** The values of all 65,536 half floats. */
export const HALF: Float32Array = Float32Array.from({ length: 65536 }, (_, bits) =>
  DataUtils.fromHalfFloat(bits),
);
