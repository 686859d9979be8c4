// Pictures of their own: at any size, with all their samples, beside the live one; one alone, or one after another.

import type { PointLight } from "../api/schema";
import { namesIn } from "../recipe";
import type { OwnMesh, View } from "../scene";
import type { Environment } from "./environment";
import { Painter, type Shown } from "./painter";
import type { Tables } from "./tables";

/** Milliseconds of work that the card is given at once: the page goes on between. */
const PIECE = 40;

/** What a picture is of, and in which light (null: the three points). */
export interface Subject extends Shown {
  readonly view: View;
  readonly environment: Environment | null;
  /** Samples that are enough, where those of the light are not asked for. */
  readonly enough?: number | undefined;
}

export class Photographer {
  private readonly canvas = document.createElement("canvas");
  private readonly painter: Painter;
  private looked: Pick<Subject, "view" | "environment"> | undefined;
  private piece = 0;
  /** Its triangles are put into an order of each painter's own. */
  private mesh: { readonly from: OwnMesh; readonly own: OwnMesh } | undefined;

  /** Of square pictures, each of so many materials at most. */
  constructor(
    tables: Tables,
    lights: readonly PointLight[],
    private readonly size: number,
    nMaterials: number,
  ) {
    this.painter = new Painter(this.canvas, tables, lights);
    this.painter.resize(size, size, nMaterials);
  }

  dispose(): void {
    this.painter.dispose();
  }

  /** The picture with a transparent background; `onProgress` is told the share of samples that are drawn. */
  async take(subject: Subject, onProgress: (share: number) => void = () => {}): Promise<OffscreenCanvas> {
    const { painter, size } = this;
    const names = namesIn(subject.recipe, subject.other);
    await this.look(subject);
    const target = Math.min(subject.enough ?? Number.POSITIVE_INFINITY, painter.targetSamples);
    while (painter.improve(names, 1, this.piece, target) > 0) {
      const isDone = painter.fence();
      while (!isDone()) await new Promise((resolve) => setTimeout(resolve, 1));
      onProgress(Math.min(...painter.samples(names)) / target);
    }
    painter.show(subject);
    const copy = new OffscreenCanvas(size, size);
    copy.getContext("2d")!.drawImage(this.canvas, 0, 0);
    return copy;
  }

  /** From where it has looked already, what is drawn stays. */
  private async look({ view, environment }: Subject): Promise<void> {
    const { painter, looked } = this;
    if (looked?.view === view && looked.environment === environment) return;
    this.looked = { view, environment };
    painter.look({ ...view, mesh: view.mesh && this.ownMesh(view.mesh) }, environment);
    if (this.piece > 0) return;
    await painter.prepare(environment);
    this.piece = Math.min(1, PIECE / painter.measure());
  }

  private ownMesh(from: OwnMesh): OwnMesh {
    if (this.mesh?.from !== from) this.mesh = { from, own: { ...from, geometry: from.geometry.clone() } };
    return this.mesh.own;
  }
}
