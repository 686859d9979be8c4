// Lights as they come: those that the page has, and pictures that are loaded when they are first chosen.

import type { Block } from "../../api/client";
import { type Environment, toEnvironment } from "../../render/environment";
import { loadPicture } from "../../render/environments";
import type { Light } from "../../scene";

export class Lights {
  /** Null under the three points. */
  private readonly environments = new Map<Light, Environment | null>([["points", null]]);
  private readonly asked = new Set<Light>();

  constructor(
    studio: Block,
    /** Runs when another has come, or could not. */
    private readonly onChange: (problem: string | null) => void,
  ) {
    this.environments.set("studio", toEnvironment(studio));
  }

  /** Undefined while it is on its way. */
  get(light: Light): Environment | null | undefined {
    if (light !== "studio" && light !== "points" && !this.asked.has(light)) {
      this.asked.add(light);
      loadPicture(light).then(
        (block) => {
          this.environments.set(light, toEnvironment(block));
          this.onChange(null);
        },
        (error: Error) => this.onChange(`The environment ${light} could not be loaded: ${error.message}`),
      );
    }
    return this.environments.get(light);
  }
}
