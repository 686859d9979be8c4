// Saving a film: what moves, its size and length, a video or its frames; and how far it is.

import type { Context } from "../../context";
import { download, dropdown, el, iconButton, popover } from "../../dom";
import { type Film, frameCount, MOTIONS, type Motion, RATE, shoot } from "../../film";
import { clamp } from "../../numbers";
import { framesReel, videoReel } from "../../reel";
import { materialName } from "../../title";
import { putBehind } from "./picture";

const TITLE = "Film";
const SIZES = [16, 2160] as const;
const LENGTHS = [0.1, 60] as const;
/** Samples of each frame. */
const QUALITIES = { good: 64, draft: 16, best: undefined } as const;
const KINDS = ["video", "frames (zip of PNG)"] as const;
type Kind = (typeof KINDS)[number];

export function filmButton(context: Context, panel: () => HTMLElement): HTMLElement {
  const { read, fields } = settings();
  const save = el("button.button.main", { type: "button" }, "Save");
  const note = el("span.quiet", { role: "status" });
  const form = popover(TITLE, ...fields, el("div.line", save, note));
  const finish = (picture: OffscreenCanvas) => putBehind(picture, panel());
  const open = iconButton("film", TITLE, () => form.togglePopover());
  // The button says it too: the window may be closed meanwhile.
  const say = (text: string) => {
    note.textContent = text;
    open.title = text ? `${TITLE}: ${text}` : TITLE;
    open.classList.toggle("running", text !== "");
  };
  let running: AbortController | null = null;
  save.addEventListener("click", async () => {
    running?.abort();
    if (running !== null) return;
    running = new AbortController();
    save.textContent = "Stop";
    const { kind, ...film } = read();
    await saved(context, film, kind, { stopped: running.signal, finish, say });
    running = null;
    save.textContent = "Save";
  });
  context.store.watch(["route"], ({ route }) => {
    open.disabled = route === null;
  });
  return el("div", open, form);
}

/** What a person chooses of a film. */
function settings(): {
  readonly read: () => Film & { readonly kind: Kind };
  readonly fields: readonly HTMLElement[];
} {
  const number = (name: string, [min, max]: readonly [number, number], step: number, value: number) =>
    el("input.field", { type: "number", name, min, max, step, value });
  const choice = (name: string, values: readonly string[]) =>
    dropdown(
      { name },
      values.map((each) => [each] as const),
      () => {},
    );
  const size = number("film-size", SIZES, 2, 720);
  const seconds = number("seconds", LENGTHS, 0.1, 4);
  const motion = choice("motion", MOTIONS);
  const quality = choice("quality", Object.keys(QUALITIES));
  const kind = choice("film-as", KINDS);
  const read = () => ({
    motion: motion.value as Motion,
    // Encoders take even sizes.
    size: 2 * Math.round(clamp(size.valueAsNumber || 720, ...SIZES) / 2),
    seconds: clamp(seconds.valueAsNumber || 4, ...LENGTHS),
    enough: QUALITIES[quality.value as keyof typeof QUALITIES],
    kind: kind.value as Kind,
  });
  const fields = [
    el("label.line.choice", "What moves", motion),
    el("label.line.choice", "Width and height", size, "pixels"),
    el("label.line.choice", `Length, ${RATE} frames a second`, seconds, "seconds"),
    el("label.line.choice", "Quality", quality),
    el("label.line.choice", "As", kind),
  ];
  return { read, fields };
}

async function saved(
  context: Context,
  film: Film,
  kind: Kind,
  {
    stopped,
    finish,
    say,
  }: {
    readonly stopped: AbortSignal;
    readonly finish: (picture: OffscreenCanvas) => void;
    readonly say: (text: string) => void;
  },
): Promise<void> {
  const { actions, store } = context;
  const start = performance.now();
  const tell = (done: number, of: number) => {
    const left = Math.ceil(((performance.now() - start) * (of - done)) / Math.max(done, 1) / 1000);
    say(`frame ${done + 1} of ${of}${done > 1 ? `, about ${left} s left` : ""}`);
  };
  say(`${frameCount(film)} frames …`);
  try {
    const reel = kind === "video" ? await videoReel(film.size, RATE) : framesReel();
    if (reel === null) throw new Error("this browser encodes no video: take the frames.");
    const name =
      film.motion === "turntable" ? `${materialName(store.get())}-turning` : store.get().stops.join("-to-");
    await actions.shoot(() => shoot(context, film, reel, { tell, stopped, finish }));
    download(await reel.end(), `${name}${reel.suffix}`);
    actions.say("material", "film", null);
  } catch (error) {
    if (!stopped.aborted)
      actions.say("material", "film", `The film could not be saved: ${(error as Error).message}`);
  }
  say("");
}
