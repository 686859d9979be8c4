// Saving the picture: its size, what is behind it, and a wait until it has all its samples.

import type { Context } from "../../context";
import { download, dropdown, el, iconButton, popover, style } from "../../dom";
import { clamp } from "../../numbers";
import { namesIn } from "../../recipe";
import { NoCardError } from "../../render/card";
import { Photographer } from "../../render/photograph";
import { drawnOf, mixingOf, otherDrawnOf } from "../../shown";
import { materialName } from "../../title";

const SIZES = [16, 4096] as const;
type Background = "transparent" | "backdrop";

export function pictureButton(context: Context, panel: () => HTMLElement): HTMLElement {
  let background: Background = "transparent";
  const [min, max] = SIZES;
  const size = el("input.field", { type: "number", name: "size", min, max, step: 1, value: 1024 });
  const behind = dropdown({ name: "background" }, [["transparent"], ["backdrop"]], (value: Background) => {
    background = value;
  });
  const save = el("button.button.main", { type: "button" }, "Save");
  const note = el("span.quiet", { role: "status" });
  const form = popover(
    "Picture",
    el("label.line.choice", "Width and height", size, "pixels"),
    el("label.line.choice", "Background", behind),
    el("div.line", save, note),
  );
  save.addEventListener("click", async () => {
    save.disabled = true;
    try {
      const pixels = clamp(Math.round(size.valueAsNumber || max / 4), min, max);
      const tell = (share: number) => {
        note.textContent = `${Math.floor(100 * share)} %`;
      };
      const picture = await context.actions.shoot(() => photographed(context, pixels, tell));
      if (background === "backdrop") putBehind(picture, panel());
      download(await picture.convertToBlob(), pictureName(context));
      context.actions.say("material", "picture", null);
    } catch (error) {
      context.actions.say(
        "material",
        "picture",
        `The picture could not be made: ${(error as Error).message}`,
      );
    }
    note.textContent = "";
    save.disabled = false;
  });
  const open = iconButton("camera", "Picture", () => form.togglePopover());
  context.store.watch(["recipe"], ({ recipe }) => {
    open.disabled = recipe.length === 0;
  });
  return el("div", open, form);
}

/** Says how it was toned: such a picture has other colours. */
function pictureName({ store }: Context): string {
  const state = store.get();
  return `${materialName(state)}${state.tone === "none" ? "" : `-${state.tone}`}.png`;
}

async function photographed(
  { store, tables, lights, thumbnails }: Context,
  size: number,
  onProgress: (share: number) => void,
): Promise<OffscreenCanvas> {
  const view = store.get();
  const { split, exposure, tone } = view;
  const [recipe, other] = [drawnOf(view), otherDrawnOf(view)];
  const environment = lights.get(view.light);
  if (environment === undefined) throw new Error("its light has not come yet.");
  try {
    const camera = new Photographer(tables, view.library.lights, size, namesIn(recipe, other).length);
    try {
      return await camera.take(
        { view, environment, recipe, other, split, exposure: 2 ** exposure, tone },
        onProgress,
      );
    } finally {
      camera.dispose();
    }
  } catch (error) {
    if (error instanceof NoCardError)
      return smallPicture(thumbnails.picture(view.recipe, mixingOf(view)), size);
    throw error;
  }
}

/** Where there is no graphics card. */
function smallPicture(small: ImageData, size: number): OffscreenCanvas {
  const [own, picture] = [new OffscreenCanvas(small.width, small.height), new OffscreenCanvas(size, size)];
  own.getContext("2d")!.putImageData(small, 0, 0);
  picture.getContext("2d")!.drawImage(own, 0, 0, size, size);
  return picture;
}

/** The panel's own backdrop (material.css), behind what is drawn. */
export function putBehind(picture: OffscreenCanvas, panel: HTMLElement): void {
  const pen = picture.getContext("2d")!;
  const { width: size } = picture;
  const [x, y] = [0.5 * size, 0.44 * size];
  // To the corner that is furthest away.
  const gradient = pen.createRadialGradient(x, y, 0, x, y, 0.78 * Math.hypot(x, size - y));
  gradient.addColorStop(0, style(panel, "--stage-in"));
  gradient.addColorStop(1, style(panel, "--stage-out"));
  pen.globalCompositeOperation = "destination-over";
  pen.fillStyle = gradient;
  pen.fillRect(0, 0, size, size);
}
