// A picture of its own: at any size, with all its samples, beside the live one.

import type { PointLight } from "../api/schema";
import { namesIn } from "../recipe";
import type { View } from "../scene";
import type { Environment } from "./environment";
import { Painter, type Shown } from "./painter";
import type { Tables } from "./tables";

/** Milliseconds of work that the card is given at once: the page goes on between. */
const PIECE = 40;

/** What a picture is of, and in which light (null: the three points). */
export interface Subject extends Shown {
  readonly view: View;
  readonly environment: Environment | null;
  readonly lights: readonly PointLight[];
}

/** The square picture with a transparent background; `onProgress` is told the share of samples that are drawn. */
export async function photograph(
  { view, environment, lights, ...shown }: Subject,
  tables: Tables,
  size: number,
  onProgress: (share: number) => void,
): Promise<OffscreenCanvas> {
  const canvas = document.createElement("canvas");
  const painter = new Painter(canvas, tables, lights);
  try {
    const names = namesIn(shown.recipe, shown.other);
    // Its triangles are put into an order of each painter's own.
    const mesh = view.mesh && { ...view.mesh, geometry: view.mesh.geometry.clone() };
    painter.resize(size, size, names.length);
    painter.look({ ...view, mesh }, environment);
    await painter.prepare(environment);
    const target = painter.targetSamples;
    const piece = Math.min(1, PIECE / painter.measure());
    while (painter.improve(names, 1, piece, target) > 0) {
      const isDone = painter.fence();
      while (!isDone()) await new Promise((resolve) => setTimeout(resolve, 1));
      onProgress(Math.min(...painter.samples(names)) / target);
    }
    painter.show(shown);
    const copy = new OffscreenCanvas(size, size);
    copy.getContext("2d")!.drawImage(canvas, 0, 0);
    return copy;
  } finally {
    painter.dispose();
  }
}
