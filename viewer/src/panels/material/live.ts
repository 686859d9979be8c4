// The live picture: the exact mixed table on the graphics card, as good as the card draws it now.

import type { Context } from "../../context";
import { el, onResize } from "../../dom";
import { paced } from "../../paced";
import type { Environment } from "../../render/environment";
import { Painter } from "../../render/painter";
import { type Needed, Quality, STILL } from "../../render/quality";
import { DRAWN, drawnOf, otherDrawnOf } from "../../shown";
import type { State } from "../../state";
import { comingUp, shownNames } from "../../wanted";
import { sayWhenLost } from "../notices";

const N_AHEAD = 12;
const SAMPLES_AHEAD = 4;
const MOST_PIXELS = 1.4e6;

/** What is said of the picture. */
export interface Progress {
  readonly materials: number;
  /** The share of their tables that has come. */
  readonly loaded: number;
  /** The fewest samples that a material has, and how many are enough. */
  readonly samples: number;
  readonly target: number;
  /** Whether no better picture comes. */
  readonly settled: boolean;
  /** How often another recipe came to be shown. */
  readonly shown: number;
}

export class LivePicture {
  private readonly painter: Painter;
  private readonly quality = new Quality();
  /** What was shown before, on top of the canvas until the new picture has come. */
  private readonly cover = el("canvas.view.hold", { "aria-hidden": "true", hidden: true });
  private readonly next = paced(() => this.frame());
  /** The light that is shown: the chosen one when it has come and the card knows how to draw it. */
  private environment: Environment | null | undefined;
  private readonly compiled = new Map<"points" | "environment", boolean>();
  /** The whole picture's. */
  private size = { width: 0, height: 0 };
  private isDone: () => boolean = () => true;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly context: Context,
    private readonly canvas: HTMLCanvasElement,
    private readonly report: (progress: Progress) => void,
  ) {
    const { store, actions, tables, lights, signal } = context;
    this.painter = new Painter(canvas, tables, store.get().library.lights);
    lights.onChange = (problem) => {
      actions.say("material", "light", problem);
      if (problem === null) this.look();
    };
    canvas.after(this.cover);
    signal.addEventListener("abort", () => {
      clearTimeout(this.timer);
      this.painter.dispose();
    });
    onResize(canvas, (width, height) => this.resize(width, height));
    store.watch(["shape", "mesh", "orbit", "light", "turn", "ownLight", "grain"], () => this.look());
    store.watch([...DRAWN, "split", "exposure", "tone"], () => {
      this.quality.materialChanged(performance.now());
      this.next();
    });
    store.watch(["arrived", "mixing", "shooting"], this.next);
    tables.onProgress = this.next;
    // All pictures went with the context, and begin again.
    sayWhenLost(context, "material", canvas, () => this.look());
  }

  private resize(width: number, height: number): void {
    const scale = Math.min(1, Math.sqrt(MOST_PIXELS / (width * height)));
    this.size = { width: width * scale, height: height * scale };
    this.quality.sized(this.size.width * this.size.height);
    this.look();
  }

  /** At what is to be seen now; all samples start over. */
  private look(): void {
    const { painter, quality } = this;
    const state = this.context.store.get();
    const chosen = this.context.lights.get(state.light);
    if (chosen !== undefined && this.compile(chosen)) this.environment = chosen;
    if (this.environment === undefined || this.size.width === 0) return;
    const { shape, mesh } = state;
    const light = this.environment === null ? "points" : "environment";
    const known = quality.turnTo([light, shape, shape === "mesh" && mesh?.name].join());
    if (!known) {
      this.fit();
      painter.look(state, this.environment);
      quality.measured(painter.measure());
    }
    quality.viewChanged(performance.now(), shownNames(state).length);
    this.fit();
    painter.look(state, this.environment);
    this.next();
  }

  /** Whether the card has compiled what a light needs; if not, it does so now. */
  private compile(environment: Environment | null): boolean {
    const light = environment === null ? "points" : "environment";
    if (!this.compiled.has(light)) {
      this.compiled.set(light, false);
      void this.painter.prepare(environment).then(() => {
        this.compiled.set(light, true);
        if (!this.context.signal.aborted) this.look();
      });
    }
    return this.compiled.get(light)!;
  }

  /** Give the picture its present size; what was shown before covers it. */
  private fit(): boolean {
    const width = Math.max(1, Math.round(this.size.width * this.quality.scale));
    const height = Math.max(1, Math.round(this.size.height * this.quality.scale));
    if (this.painter.hasSize(width, height)) return false;
    if (this.cover.hidden) {
      this.cover.width = this.canvas.width;
      this.cover.height = this.canvas.height;
      this.cover.getContext("2d")!.drawImage(this.canvas, 0, 0);
      this.setCovered(true);
    }
    this.painter.resize(width, height);
    return true;
  }

  /** What is under the cover would be seen around the object. */
  private setCovered(isCovered: boolean): void {
    this.cover.hidden = !isCovered;
    this.canvas.style.opacity = isCovered ? "0" : "";
  }

  private frame(): void {
    clearTimeout(this.timer);
    if (this.environment === undefined || this.size.width === 0) return;
    const { painter, quality } = this;
    const now = performance.now();
    const state = this.context.store.get();
    const names = shownNames(state);
    quality.asked(this.isDone(), now);
    const needed = this.needed(names);
    if (state.shooting && needed.unseen === 0) {
      this.show(state, names);
      return;
    }
    const { pieces, piece, target } = quality.plan(now, needed);
    if (this.fit()) painter.look(state, this.environment);
    const added = painter.improve(names, pieces, piece, target);
    // Then what the slider meets next, at a few samples: crossing into it shows at once.
    const left = drawnOf(state).length > 0 && added < pieces ? Math.ceil(pieces / 2) : 0;
    const ahead = left && painter.improve(comingUp(state).slice(0, N_AHEAD), left, piece, SAMPLES_AHEAD);
    if (added + ahead > 0) {
      this.isDone = painter.fence();
      quality.began((added + ahead) * piece, now);
    }
    this.show(state, names);
    if (quality.isWaiting || pieces === 0) this.next();
    else if (quality.isSmall) this.timer = setTimeout(this.next, STILL);
  }

  private show(state: State, names: readonly string[]): void {
    const { painter, quality } = this;
    const { split, exposure, tone, mixing } = state;
    const [recipe, other] = [drawnOf(state), otherDrawnOf(state)];
    const drawn = painter.show({ recipe, other, split, exposure: 2 ** exposure, tone });
    const needed = this.needed(names);
    this.setCovered(quality.covers(drawn, needed));
    this.report({
      materials: names.length,
      loaded: this.context.tables.share(names),
      samples: recipe.length > 0 ? needed.fewest : 0,
      target: needed.target,
      settled: recipe.length > 0 && mixing.length === 0 && quality.settled(needed),
      shown: painter.changes,
    });
  }

  private needed(names: readonly string[]): Needed {
    const samples = this.painter.samples(names);
    return {
      count: names.length,
      unseen: samples.filter((n) => n === 0).length,
      fewest: samples.length === names.length ? Math.min(...samples) : 0,
      target: this.painter.targetSamples,
    };
  }
}
