// What is looked at before it is chosen: its name and small picture at once, until it is drawn on the object.

import type { Context } from "../../context";
import { el } from "../../dom";
import { meanWeight } from "../../recipe";
import type { Ghost } from "../../state";

/** Materials that say what a mix is. */
const MOST = 2;

export function ghostTag(context: Context): HTMLElement {
  const { store, thumbnails, root } = context;
  const picture = el("canvas", { width: thumbnails.size, height: thumbnails.size });
  const name = el("span.cut");
  const element = el(
    "div.line.tag.ghost",
    { role: "status", hidden: true },
    picture,
    name,
    el("span.quiet", "not chosen yet"),
  );
  store.watch(["ghost", "pointed", "pictured"], ({ ghost, pointed, pictured }) => {
    const shown = ghost ?? (pointed && "recipe" in pointed ? pointed : null);
    element.hidden = shown === null || !pictured;
    root.classList.toggle("haunted", ghost !== null);
    if (shown === null || !pictured) return;
    name.textContent = titleOf(shown);
    const draw = () =>
      picture.getContext("2d")!.putImageData(thumbnails.picture(shown.recipe, shown, draw), 0, 0);
    draw();
  });
  return element;
}

function titleOf({ name, recipe }: Ghost): string {
  if (recipe.length === 1) return name;
  const most = [...recipe].sort((a, b) => meanWeight(b) - meanWeight(a)).slice(0, MOST);
  return `${name}: ${most.map((each) => `${Math.round(100 * meanWeight(each))} % ${each.name}`).join(", ")}${recipe.length > MOST ? " …" : ""}`;
}
