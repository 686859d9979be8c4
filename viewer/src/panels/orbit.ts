// Turning the object: drag, and the wheel for the distance.

import type { Context } from "../context";

export function orbitOnDrag({ store }: Context, canvas: HTMLCanvasElement): void {
  let from: { x: number; y: number } | null = null;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    from = { x: event.clientX, y: event.clientY };
  });
  canvas.addEventListener("pointermove", (event) => {
    if (from === null) return;
    turn(-(event.clientX - from.x) * 0.008, (event.clientY - from.y) * 0.008);
    from = { x: event.clientX, y: event.clientY };
  });
  for (const end of ["pointerup", "pointercancel"])
    canvas.addEventListener(end, () => {
      from = null;
    });
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
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const { orbit } = store.get();
      store.set({
        orbit: { ...orbit, zoom: Math.min(Math.max(orbit.zoom * Math.exp(-event.deltaY * 0.001), 0.4), 4) },
      });
    },
    { passive: false },
  );
}
