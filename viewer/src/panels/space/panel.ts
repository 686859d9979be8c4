// The space: where each material is, what is between them, and the route.

import type { Context } from "../../context";
import { el, iconButton } from "../../dom";
import { NoCardError } from "../../render/card";
import { Cloud } from "../../render/cloud";
import { GRID } from "../../state";
import { notices } from "../notices";
import { gridFilters, materialGrid } from "./grid";
import { numberChoices } from "./measured";
import { SpacePicture } from "./picture";

export function spacePanel(context: Context): HTMLElement {
  const canvas = el("canvas.view.cloud", {
    tabindex: 0,
    role: "img",
    "aria-label": "The materials as points; Alt and an arrow turn them, and the search reaches them all",
  });
  const maps = el("div.maps");
  const area = el("div.area", canvas);
  const note = el("span.note");
  const title = el("div.line.bar", el("h2", "Space"), maps);
  const filters = gridFilters(context);
  const home = iconButton("home", "See the whole space", () => cloud?.goHome());
  home.hidden = true;
  const measures = numberChoices(context);
  const foot = el("div.line.bar", note, home, filters, measures);
  const panel = el(
    "section.panel.space",
    { "aria-label": "Space" },
    title,
    area,
    foot,
    notices(context, "space"),
  );
  let begun = false;
  let cloud: Cloud | undefined;
  // The materials are drawn as their pictures.
  context.store.watch(["pictured"], ({ pictured }) => {
    if (!pictured || begun) return;
    begun = true;
    try {
      cloud = new Cloud(canvas, context.names, context.thumbnails);
      cloud.controls.addEventListener("change", () => {
        home.hidden = cloud!.isHome;
      });
      area.append(new SpacePicture(context, cloud, canvas, { maps, note }).labels.element);
    } catch (error) {
      if (!(error instanceof NoCardError)) throw error;
      context.actions.say(
        "space",
        "card",
        "The space itself needs WebGL2, which this browser does not have.",
      );
      context.store.set({ map: GRID });
    }
  });
  let grid: HTMLElement | undefined;
  context.store.watch(["map", "pictured"], ({ map, pictured }) => {
    const isGrid = map === GRID;
    if (isGrid && pictured && !grid) {
      grid = materialGrid(context);
      area.append(grid);
    }
    area.classList.toggle("side-by-side", isGrid);
    filters.hidden = !isGrid;
  });
  return panel;
}
