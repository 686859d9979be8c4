// Where the present material may go: it can leave the route on a map whose coordinates are those of the space.

import type { Vector3 } from "three";

import type { Context } from "../../context";
import { pointOf, withCoordinates } from "../../coordinates";
import type { Cloud } from "../../render/cloud";
import { CoordinateMap } from "../../render/maps";
import type { State } from "../../state";

/** How near the pointer has to be to take the present material, in CSS pixels. */
const MARKER = 11;

export class FreePoint {
  /** Where the present material is. */
  here: Vector3 | null = null;

  constructor(
    private readonly context: Context,
    private readonly cloud: Cloud,
  ) {}

  /** Whether the present material can leave the route on this map. */
  get isFree(): boolean {
    const { view, map } = this.context.store.get();
    return !!view?.has_points && view.embeddings.some(({ name }) => name === map);
  }

  /** Whether the pointer is at the present material, which can be dragged. */
  isAt(x: number, y: number): boolean {
    if (this.here === null || !this.isFree) return false;
    const at = this.cloud.project(this.here);
    return Math.hypot(at.x - x, at.y - y) <= MARKER;
  }

  drag(x: number, y: number): void {
    const there = this.pointAt(x, y);
    if (there !== null) this.context.actions.goTo(there);
  }

  /** A point that is pointed at, where the present material could go. */
  under(x: number, y: number): State["pointed"] {
    const there = this.isFree && !this.isAt(x, y) ? this.pointAt(x, y) : null;
    return there && { point: there };
  }

  /** The point of the space under the pointer, as far away as the present material; null where the map has none. */
  private pointAt(x: number, y: number): number[] | null {
    const { store, names } = this.context;
    const { view, recipe, point, map: chosen } = store.get();
    const { map } = this.cloud;
    if (!(map instanceof CoordinateMap) || view === null || this.here === null) return null;
    const coordinates = map.coordinatesAt(this.cloud.unproject(x, y, this.here));
    return withCoordinates(view, point ?? pointOf(view, names, recipe), chosen, coordinates);
  }
}
