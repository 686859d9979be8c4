// Turning the object: drag, or Alt and an arrow; the wheel or two fingers for the distance.

import type { Context } from "../../context";
import { turned, zoomed } from "../../scene";

interface Point {
  readonly x: number;
  readonly y: number;
}

/** Radians for a pixel, and for a key. */
const DRAGGED = 0.008;
const PRESSED = 0.1;
const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [1, 0],
  ArrowRight: [-1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

export function orbitOnDrag({ store }: Context, canvas: HTMLCanvasElement): void {
  const turn = (azimuth: number, elevation: number) =>
    store.set({ orbit: turned(store.get().orbit, azimuth, elevation) });
  const turnLight = (radians: number) => {
    const degrees = store.get().turn + (radians * 180) / Math.PI;
    store.set({ turn: Math.round(((((degrees + 180) % 360) + 360) % 360) - 180) });
  };
  const zoom = (factor: number) => store.set({ orbit: zoomed(store.get().orbit, factor) });
  listenToFingers(canvas, turn, zoom, turnLight);
  turnOnKeys(canvas, turn);
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      zoom(Math.exp(-event.deltaY * 0.001));
    },
    { passive: false },
  );
}

/** One finger, or the mouse, turns, and the light with Shift; two zoom. */
function listenToFingers(
  canvas: HTMLCanvasElement,
  turn: (azimuth: number, elevation: number) => void,
  zoom: (factor: number) => void,
  turnLight: (radians: number) => void,
): void {
  const down = new Map<number, Point>();
  canvas.addEventListener("pointerdown", ({ pointerId, clientX: x, clientY: y }) => {
    canvas.setPointerCapture(pointerId);
    down.set(pointerId, { x, y });
  });
  canvas.addEventListener("pointermove", ({ pointerId, shiftKey, clientX: x, clientY: y }) => {
    const from = down.get(pointerId);
    if (from === undefined) return;
    const other = [...down].find(([id]) => id !== pointerId)?.[1];
    if (other === undefined && shiftKey) turnLight((x - from.x) * DRAGGED);
    else if (other === undefined) turn(-(x - from.x) * DRAGGED, (y - from.y) * DRAGGED);
    else zoom(distance({ x, y }, other) / Math.max(distance(from, other), 1));
    down.set(pointerId, { x, y });
  });
  for (const end of ["pointerup", "pointercancel"] as const)
    canvas.addEventListener(end, ({ pointerId }) => down.delete(pointerId));
}

/** Alt and an arrow turn what the canvas shows: radians of azimuth and elevation. */
export function turnOnKeys(
  canvas: HTMLCanvasElement,
  turn: (azimuth: number, elevation: number) => void,
): void {
  canvas.addEventListener("keydown", (event) => {
    const arrow = ARROWS[event.key];
    if (arrow === undefined || !event.altKey) return;
    event.preventDefault();
    turn(PRESSED * arrow[0], PRESSED * arrow[1]);
  });
}

function distance(a: Point, b: Point): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}
