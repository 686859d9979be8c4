// Names beside their points, towards the middle of the panel and below a name that is in the way; and marks at points.

import type { Vector3 } from "three";

import { el } from "../../dom";
import { clamp } from "../../numbers";
import type { Cloud } from "../../render/cloud";
import type { CoordinateMap } from "../../render/maps";
import { short } from "../brdf/plot";

/** A point that has a name. */
export interface Named {
  readonly name: string;
  readonly point: Vector3;
  readonly isHovered: boolean;
}

/** Where the present material is, where a person asked for one, and whether it can be moved there. */
interface Marks {
  readonly here: Vector3 | null;
  readonly asked: Vector3 | null;
  readonly isFree: boolean;
}

const FREE = "The present material: drag it, or press arrows, to leave the route";
/** CSS pixels that a key moves it. */
const PRESSED = 8;
const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

export class Labels {
  readonly element: HTMLElement;
  private readonly names = el("div.tags", { "aria-hidden": "true" });
  private readonly ticks = el("div.tags", { "aria-hidden": "true" });
  /** The present material: where it can be moved off the route, arrows do so. */
  private readonly here: HTMLButtonElement;
  /** Where a person pointed, when no mix is there. */
  private readonly asked = el("div.asked");

  /** Where names stand. */
  private taken: readonly Box[] = [];

  constructor(move: (x: number, y: number) => void) {
    this.here = el("button.here", {
      type: "button",
      onkeydown: (event) => {
        const arrow = ARROWS[event.key];
        if (arrow === undefined || event.altKey || this.here.disabled) return;
        event.preventDefault();
        event.stopPropagation();
        const box = this.here.getBoundingClientRect();
        const own = this.element.getBoundingClientRect();
        const step = event.shiftKey ? 5 * PRESSED : PRESSED;
        move(
          box.x + box.width / 2 - own.x + step * arrow[0],
          box.y + box.height / 2 - own.y + step * arrow[1],
        );
      },
    });
    this.element = el("div.labels", this.ticks, this.names, this.asked, this.here);
  }

  /** Values along the axes of a map, and at the last one what the axis is called. */
  drawTicks(cloud: Cloud, axes: ReturnType<CoordinateMap["axes"]>): void {
    const ticks = axes.flatMap(({ name, ticks }) =>
      ticks.map(({ value, at }, i) => ({
        at: cloud.project(at),
        element: el("span.tick", i === ticks.length - 1 ? `${inWords(name)} ${short(value)}` : short(value)),
      })),
    );
    this.ticks.replaceChildren(...ticks.map(({ element }) => element));
    const boxes = ticks.map(({ at: { x, y }, element: { offsetWidth: width, offsetHeight: height } }) => {
      return { x, y, width, height };
    });
    const { clientWidth, clientHeight } = this.element;
    apart(boxes, this.taken, clientWidth, clientHeight).forEach(({ x, y }, i) => {
      ticks[i]!.element.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
    });
  }

  draw(cloud: Cloud, width: number, named: readonly Named[], { here, asked, isFree }: Marks): void {
    const anchors = named.map(({ point }) => ({
      ...cloud.project(point),
      gap: cloud.radius(point) * 1.5 + 5,
    }));
    const labels = labelPositions(anchors, width).map(({ x, y, side }, i) => {
      const { name, isHovered } = named[i]!;
      const label = el(isHovered ? "div.tag.cut.label.hovered" : "div.tag.cut.label", name);
      label.style.transform = `translate(${x}px, ${y}px) translate(${side === "left" ? "-100%" : "0"}, -50%)`;
      return { x, y, side, element: label };
    });
    this.names.replaceChildren(...labels.map(({ element }) => element));
    this.taken = labels.map(({ x, y, side, element: { offsetWidth: width, offsetHeight: height } }) => {
      return { x: side === "left" ? x - width / 2 : x + width / 2, y, width, height };
    });
    mark(this.here, cloud, here);
    mark(this.asked, cloud, asked);
    this.here.disabled = !isFree;
    this.here.setAttribute("aria-label", isFree ? FREE : "The present material");
  }
}

function mark(element: HTMLElement, cloud: Cloud, point: Vector3 | null): void {
  element.hidden = point === null;
  if (point === null) return;
  const { x, y } = cloud.project(point);
  element.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
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

/** A text around its middle, in CSS pixels. */
export interface Box {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** The same boxes inside the panel, each up or down from where it was until it covers none before it, and none that stays. */
export function apart(
  boxes: readonly Box[],
  staying: readonly Box[],
  width: number,
  height: number,
): readonly Box[] {
  const free = [...staying];
  for (const box of boxes) {
    const inside = (y: number): Box => ({
      ...box,
      x: clamp(box.x, box.width / 2, Math.max(width - box.width / 2, box.width / 2)),
      y: clamp(y, box.height / 2, Math.max(height - box.height / 2, box.height / 2)),
    });
    const steps = Array.from({ length: 4 * boxes.length }, (_, i) => (i * box.height) / 2);
    const tried = steps.flatMap((step) => [inside(box.y - step), inside(box.y + step)]);
    free.push(tried.find((each) => !free.some((other) => covers(each, other))) ?? inside(box.y));
  }
  return free.slice(staying.length);
}

function covers(a: Box, b: Box): boolean {
  return 2 * Math.abs(a.x - b.x) < a.width + b.width && 2 * Math.abs(a.y - b.y) < a.height + b.height;
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

/** What an axis is called on the page. */
export function inWords(axis: string): string {
  const body = /^body.([rgb])$/.exec(axis);
  if (body) return `body ${{ r: "red", g: "green", b: "blue" }[body[1] as "r" | "g" | "b"]}`;
  return axis;
}
