// The graphics card, where there is one.

import { WebGLRenderer, type WebGLRendererParameters } from "three";

/** There is no graphics card that can draw this. */
export class NoCardError extends Error {}

export function toRenderer(options: WebGLRendererParameters): WebGLRenderer {
  try {
    return new WebGLRenderer(options);
  } catch (error) {
    throw new NoCardError(error instanceof Error ? error.message : String(error));
  }
}
