// The pointer on the space: over it, a click, and dragging what can be dragged.

export interface Pointer {
  readonly hover: (x: number, y: number) => void;
  readonly leave: () => void;
  readonly click: (x: number, y: number) => void;
  /** True when what is under the pointer is to be dragged. */
  readonly grab: (x: number, y: number) => boolean;
  readonly drag: (x: number, y: number) => void;
  readonly release: () => void;
}

/** A pointer that moved less between down and up was a click, in CSS pixels. */
const STILL = 4;

export function listenToPointer(canvas: HTMLCanvasElement, pointer: Pointer): void {
  let down: { x: number; y: number } | null = null;
  let dragging = false;
  const end = () => {
    if (dragging) pointer.release();
    down = null;
    dragging = false;
  };
  canvas.addEventListener("pointermove", ({ offsetX, offsetY, buttons }) => {
    if (dragging) pointer.drag(offsetX, offsetY);
    else if (buttons === 0) pointer.hover(offsetX, offsetY);
  });
  canvas.addEventListener("pointerleave", pointer.leave);
  // Before the controls hear of it, so that they can be told to stay.
  canvas.addEventListener(
    "pointerdown",
    ({ offsetX, offsetY, button, pointerId }) => {
      down = button === 0 ? { x: offsetX, y: offsetY } : null;
      dragging = down !== null && pointer.grab(offsetX, offsetY);
      // Let go of beside the panel, it is let go of all the same.
      if (dragging) canvas.setPointerCapture(pointerId);
    },
    { capture: true },
  );
  canvas.addEventListener("pointerup", ({ offsetX, offsetY }) => {
    const moved = down ? Math.hypot(offsetX - down.x, offsetY - down.y) : Number.POSITIVE_INFINITY;
    if (!dragging && moved < STILL) pointer.click(offsetX, offsetY);
    end();
  });
  canvas.addEventListener("pointercancel", end);
}
