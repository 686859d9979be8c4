// Turning the object: drag, or Alt and an arrow; the wheel or two fingers for the distance.

import type { Context } from "../context";

interface Place {
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
  const down = new Map<number, Place>();
  canvas.addEventListener("pointerdown", ({ pointerId, clientX: x, clientY: y }) => {
    canvas.setPointerCapture(pointerId);
    down.set(pointerId, { x, y });
  });
  canvas.addEventListener("pointermove", ({ pointerId, clientX: x, clientY: y }) => {
    const from = down.get(pointerId);
    if (from === undefined) return;
    const other = [...down].find(([id]) => id !== pointerId)?.[1];
    if (other === undefined) turn(-(x - from.x) * DRAGGED, (y - from.y) * DRAGGED);
    else zoom(distance({ x, y }, other) / Math.max(distance(from, other), 1));
    down.set(pointerId, { x, y });
  });
  for (const end of ["pointerup", "pointercancel"] as const)
    canvas.addEventListener(end, ({ pointerId }) => down.delete(pointerId));
  const turn = (azimuth: number, elevation: number) => {
    const { orbit } = store.get();
    store.set({
      orbit: {
        ...orbit,
        azimuth: orbit.azimuth + azimuth,
        elevation: Math.min(Math.max(orbit.elevation + elevation, -1.4), 1.4),
      },
    });
  };
  const zoom = (factor: number) => {
    const { orbit } = store.get();
    store.set({ orbit: { ...orbit, zoom: Math.min(Math.max(orbit.zoom * factor, 0.4), 4) } });
  };
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

function distance(a: Place, b: Place): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}
