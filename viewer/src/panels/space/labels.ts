// Names beside their points, towards the middle of the panel and below a name that is in the way; and marks at points.

import type { Vector3 } from "three";

import { el } from "../../dom";
import type { Cloud } from "../../render/cloud";

/** A point that has a name. */
export interface Named {
  readonly name: string;
  readonly point: Vector3;
  readonly isHovered: boolean;
}

export class Labels {
  readonly element = el("div.labels", { "aria-hidden": "true" });
  private readonly here = el("div.here");
  /** Where a person pointed, when no mix is there. */
  private readonly asked = el("div.asked");

  draw(
    cloud: Cloud,
    width: number,
    named: readonly Named[],
    here: Vector3 | null,
    asked: Vector3 | null,
  ): void {
    const anchors = named.map(({ point }) => ({
      ...cloud.project(point),
      gap: cloud.radius(point) * 1.5 + 5,
    }));
    const labels = labelPositions(anchors, width).map(({ x, y, side }, i) => {
      const { name, isHovered } = named[i]!;
      const label = el(isHovered ? "div.tag.cut.label.hovered" : "div.tag.cut.label", name);
      label.style.transform = `translate(${x}px, ${y}px) translate(${side === "left" ? "-100%" : "0"}, -50%)`;
      return label;
    });
    const marks = [here && mark(this.here, cloud, here), asked && mark(this.asked, cloud, asked)];
    this.element.replaceChildren(...marks.filter((each) => each !== null), ...labels);
  }
}

function mark(element: HTMLElement, cloud: Cloud, point: Vector3): HTMLElement {
  const { x, y } = cloud.project(point);
  element.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
  return element;
}

/** A point that has a name, in CSS pixels. */
export interface Anchor {
  readonly x: number;
  readonly y: number;
  /** From the point to its name. */
  readonly gap: number;
}

export interface LabelPosition {
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

export function labelPositions(anchors: readonly Anchor[], width: number): LabelPosition[] {
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
