// Where names stand beside their points: towards the middle of the panel, and below a name that is in the way.

/** A point that has a name, in CSS pixels. */
export interface Anchor {
  readonly x: number;
  readonly y: number;
  /** From the point to its name. */
  readonly gap: number;
}

export interface LabelPlace {
  /** The edge of the name that is at the point. */
  readonly x: number;
  /** The middle of its height. */
  readonly y: number;
  readonly side: "left" | "right";
}

/** About what a name takes. */
const WIDTH = 150;
const HEIGHT = 23;
const STEP = 4;
/** Where the names change sides, as a share of the panel's width. */
const FAR = 0.62;

export function labelPlaces(anchors: readonly Anchor[], width: number): LabelPlace[] {
  const taken: { left: number; y: number }[] = [];
  return anchors.map(({ x, y, gap }) => {
    const side = x > FAR * width ? "left" : "right";
    const edge = side === "right" ? x + gap : x - gap;
    const left = side === "right" ? edge : edge - WIDTH;
    let free = y;
    while (taken.some((other) => Math.abs(other.y - free) < HEIGHT && Math.abs(other.left - left) < WIDTH))
      free += STEP;
    taken.push({ left, y: free });
    return { x: edge, y: free, side };
  });
}
