// The body colour of the present material, to be changed: everything else stays as near as a mix can be.

import { mappingOf } from "../../blend";
import { fromHex, toHex } from "../../colour";
import type { Context } from "../../context";
import { coordinatesIn, pointOf, withCoordinates } from "../../coordinates";
import { el } from "../../dom";
import { isAway } from "../../shown";

const BODY = "Body colour";

export function bodyColour({ store, actions, names }: Context): HTMLElement {
  const choose = () => {
    const { view, point, recipe, blend } = store.get();
    if (view === null) return;
    // A matte surface of reflectance x has x / pi in 1/sr.
    const body = fromHex(input.value).map((x) => mappingOf(blend).to(x / Math.PI));
    actions.goTo(withCoordinates(view, point ?? pointOf(view, names, recipe), BODY, body));
  };
  const input = el("input", { type: "color", "aria-label": BODY, oninput: choose });
  const label = el("label.line", input, BODY);
  const note = el("span.note", { role: "status" });
  const leave = () => actions.setT(store.get().t);
  const back = el("button.button", { type: "button", onclick: leave }, "Back to route");
  const element = el("div.line.wrap.adjustment", label, note, back);
  store.watch(["view", "recipe", "atPoint", "held"], ({ view, recipe, atPoint, held, blend }) => {
    const has = !!view?.has_points && view.embeddings.some(({ name }) => name === BODY);
    const away = isAway({ atPoint, held });
    element.hidden = !has && !away;
    label.hidden = !has;
    input.disabled = recipe.length === 0;
    back.hidden = !away;
    note.textContent = atPoint === null || atPoint.inside ? "" : "no mix is just there: this is one nearby";
    if (!view || !has || recipe.length === 0 || input.matches(":focus")) return;
    const body = coordinatesIn(view, pointOf(view, names, recipe), BODY);
    input.value = toHex(body.map((x) => mappingOf(blend).back(x) * Math.PI));
  });
  return element;
}
