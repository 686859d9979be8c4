// Lights as they come: those that the page has, and pictures that are loaded when they are first chosen.

import type { Block } from "../api/client";
import { pauseAfter } from "../paced";
import type { Light, Picture } from "../scene";
import { type Environment, toEnvironment } from "./environment";
import { loadPicture } from "./environments";

export class Lights {
  /** Null under the three points. */
  private readonly environments = new Map<Light, Environment | null>([["points", null]]);
  private readonly asked = new Set<Light>();
  /** Runs when another has come, or could not. */
  onChange: (problem: string | null) => void = () => {};
  private failures = 0;

  constructor(studio: Block) {
    this.environments.set("studio", toEnvironment(studio));
  }

  /** Undefined while it is on its way. */
  get(light: Light): Environment | null | undefined {
    if (!this.environments.has(light) && !this.asked.has(light)) {
      this.asked.add(light);
      void this.load(light as Picture);
    }
    return this.environments.get(light);
  }

  /** A person's own picture. */
  put(block: Block): void {
    this.environments.set("own", toEnvironment(block));
  }

  private async load(picture: Picture): Promise<void> {
    try {
      this.environments.set(picture, toEnvironment(await loadPicture(picture)));
      this.failures = 0;
      this.onChange(null);
    } catch (error) {
      const again = () => {
        this.asked.delete(picture);
        this.onChange(null);
      };
      setTimeout(again, pauseAfter(this.failures++));
      const { message } = error as Error;
      this.onChange(`The light ${picture} could not be loaded (${message}): it is tried again.`);
    }
  }
}
