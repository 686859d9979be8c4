// How good a picture can be had now: how large it is, what it gets in a frame, and how long what was shown before stays on top.
//
// On a fast card the picture is always whole. On a slow one, or none, it is small from a change on until it has its samples and
// nothing has changed for a while; then the whole one is made beneath it. So a change is on the screen when each material of the
// recipe has one sample in a picture that is small enough for that.
//
//     small --(enough samples, nothing changes)--> whole, covered by the small one --(more samples than noise)--> whole
//       ^--------------(a change that the whole picture would show too late)------------------'--------------------'
//
// What a pass (one sample of one material over the whole picture) costs is learnt while the card works: a batch of passes was
// done between two looks at the card, so it lies between two bounds, however coarse the clock is and however busy the page.
// Neither card nor page nor clock is known here.

import { clamp } from "../numbers";

/** What the picture needs, as far as tables are there. */
export interface Needed {
  /** Materials of what is shown. */
  readonly count: number;
  /** Those that can be drawn and have no sample. */
  readonly unseen: number;
  /** The fewest samples that any has. */
  readonly fewest: number;
  /** So many samples are enough. */
  readonly target: number;
}

/** What to do in this frame, in a picture of the present scale. */
export interface Plan {
  /** So many pieces of work, each a pass over this share of the picture: what the card has begun cannot be taken back. */
  readonly pieces: number;
  readonly piece: number;
  /** Samples that each material gets before those that come next get any. */
  readonly target: number;
}

/** What the card works on. */
interface Batch {
  readonly passes: number;
  readonly from: number;
  /** When it was last seen not to be done. */
  seen: number;
  /** Whether it is about the present picture. */
  counts: boolean;
}

/** Passes over the present picture, and the least and the most milliseconds that they took. */
interface Spent {
  readonly passes: number;
  readonly least: number;
  readonly most: number;
}

const NOTHING: Spent = { passes: 0, least: 0, most: 0 };

/** With so many samples a whole picture is less noisy than the small one that it replaces. */
export const SAMPLES_TO_SHOW = 48;
/** Milliseconds after a change in which the next one is expected, and after which none is. */
const MOVING = 250;
export const STILL = 800;
/** Share of the time while something moves that goes into a better picture. */
const SPARE = 0.15;
/** Milliseconds that a pass over a small picture may take, and the first sample of all materials together. */
const PASS = 40;
const FIRST = 300;
/** Milliseconds after which first samples come too late: the picture is made smaller. */
const LATE = 2 * FIRST;
/** Milliseconds of work that are given to the card at once: first samples, and others. */
const FIRST_BATCH = 100;
const BATCH = 50;
const PIECE = 80;
const MOST_PIECES = 64;
/** The picture is not smaller than this share of its width, however slow. */
const LEAST_SCALE = 0.1;
/** One that would be hardly smaller is whole. */
const NEARLY = 0.9;
/** A small picture stays as it is unless another size would be that much better. */
const HARDLY = 1.4;
/** One that turns out to be far smaller than it could be starts over. */
const FAR_LARGER = 2;
/** How many measurements of the card are remembered. */
const MEMORY = 4;
const FRESH: readonly number[] = Array(MEMORY - 1).fill(0);
/** Milliseconds for a pass: a coarse clock says 0, and what was never measured is slow. */
const LEAST_COST = 0.05;
const UNKNOWN_COST = 1000;

export class Quality {
  private share = 1;
  /** What lies on top: nothing, what was shown before until anything is drawn, or the small picture until the whole is fine. */
  private cover: "none" | "drawn" | "fine" = "none";
  private changed = Number.NEGATIVE_INFINITY;
  private planned = 0;
  private spared = 0;
  private batch: Batch | null = null;
  private spent = NOTHING;
  /** The least that passes over the whole picture cost of late. */
  private recent: readonly number[] = FRESH;
  /** Milliseconds of a pass for each pixel, by what is drawn. */
  private readonly costs = new Map<string, number>();
  private drawn = "";
  private pixels = 1;

  /** What a pass draws from now on: light and object; whether its cost is known. */
  turnTo(drawn: string): boolean {
    if (drawn !== this.drawn) this.recent = FRESH;
    this.drawn = drawn;
    return this.costs.has(drawn);
  }

  /** The whole picture has so many pixels from now on. */
  sized(pixels: number): void {
    this.pixels = pixels;
    this.cover = "drawn";
  }

  /** A pass over the present picture was waited for. */
  measured(milliseconds: number): void {
    this.cost = milliseconds / this.scale ** 2;
  }

  /** All samples start over. */
  viewChanged(now: number, count: number): void {
    this.changed = now;
    if (this.cover === "fine") this.cover = "drawn";
    const scale = this.fitting(count);
    const factor = Math.max(scale / this.scale, this.scale / scale);
    if (factor > HARDLY || (this.scale === 1) !== (scale === 1)) this.restart(scale, "drawn");
  }

  /** Samples stay: the recipe, what it is compared with, or how it is shown. */
  materialChanged(now: number): void {
    this.changed = now;
    if (this.cover === "fine") this.cover = "drawn";
  }

  plan(now: number, needed: Needed): Plan {
    this.resize(now, needed);
    const piece = Math.min(1, PIECE / this.pass);
    const pieces = this.batch === null ? this.pieces(now, needed.unseen, piece) : 0;
    this.planned = now;
    const enough = this.scale < 1 ? Math.min(SAMPLES_TO_SHOW, needed.target) : needed.target;
    return { pieces, piece, target: needed.unseen > 0 ? 1 : enough };
  }

  /** Whether the cover stays, when the present picture has been drawn and each material has so many samples. */
  covers(drawn: boolean, { fewest, target }: Needed): boolean {
    const fine = this.cover === "fine" && fewest >= Math.min(SAMPLES_TO_SHOW, target);
    if (fine || (this.cover === "drawn" && drawn)) this.cover = "none";
    return this.cover !== "none";
  }

  /** Whether no better picture comes: it is whole, and has its samples. */
  settled({ fewest, target }: Needed): boolean {
    return this.scale === 1 && fewest >= target;
  }

  /** Width and height of the picture as a share of the whole one's. */
  get scale(): number {
    return this.share;
  }

  /** Whether a whole picture comes when nothing changes. */
  get isSmall(): boolean {
    return this.scale < 1;
  }

  get isWaiting(): boolean {
    return this.batch !== null;
  }

  /** Passes, or a part of one, were given to the card. */
  began(passes: number, now: number): void {
    this.batch = { passes, from: now, seen: now, counts: true };
  }

  /** The card was asked whether it has done them. */
  asked(done: boolean, now: number): void {
    const { batch, spent } = this;
    if (batch === null) return;
    if (!done) {
      batch.seen = now;
      return;
    }
    this.batch = null;
    if (!batch.counts) return;
    this.spent = {
      passes: spent.passes + batch.passes,
      least: spent.least + batch.seen - batch.from,
      most: spent.most + now - batch.from,
    };
    this.learn();
  }

  /** From whole passes, for parts of a picture differ; or from what took long in any case. */
  private learn(): void {
    const { passes, least, most } = this.spent;
    if (passes < 1 && least < LATE) return;
    this.spent = NOTHING;
    const share = Math.max(passes, 1) * this.scale ** 2;
    // The card may have been busy with something else: only what it never did faster of late is its cost, or what is far off.
    this.recent = [...this.recent.slice(1 - MEMORY), least / share];
    const atLeast = least >= LATE ? least / share : Math.min(...this.recent);
    if (passes >= 1 && most / share < this.cost) this.cost = Math.max(most / share, this.cost / 2);
    else if (atLeast > this.cost) this.cost = atLeast;
  }

  /** Milliseconds of a pass over the whole picture. */
  private get cost(): number {
    return (this.costs.get(this.drawn) ?? UNKNOWN_COST / this.pixels) * this.pixels;
  }

  private set cost(milliseconds: number) {
    this.costs.set(this.drawn, Math.max(milliseconds, LEAST_COST) / this.pixels);
  }

  /** Milliseconds of a pass over the present picture. */
  private get pass(): number {
    return this.cost * this.scale ** 2;
  }

  private resize(now: number, { count, unseen, fewest }: Needed): void {
    const late = unseen * this.pass > LATE;
    const fitting = this.fitting(count);
    if (this.cover !== "fine" && late && fitting < this.scale) this.restart(fitting, "drawn");
    if (this.scale === 1 || fewest === 0) return;
    const still = fewest >= SAMPLES_TO_SHOW && now - this.changed >= STILL;
    if (still || fitting === 1) this.restart(1, "fine");
    else if (fitting > FAR_LARGER * this.scale) this.restart(fitting, "drawn");
  }

  private restart(scale: number, cover: "drawn" | "fine"): void {
    this.share = scale;
    this.cover = cover;
    this.spent = NOTHING;
    if (this.batch) this.batch.counts = false;
  }

  /** The scale at which the card keeps up with changes of so many materials. */
  private fitting(count: number): number {
    const scale = Math.sqrt(Math.min(PASS, FIRST / Math.max(count, 1)) / this.cost);
    return scale >= NEARLY ? 1 : Math.max(LEAST_SCALE, scale);
  }

  private pieces(now: number, unseen: number, piece: number): number {
    const milliseconds = piece * this.pass;
    if (unseen > 0) return clamp(Math.floor(FIRST_BATCH / milliseconds), 1, Math.ceil(unseen / piece));
    if (now - this.changed >= MOVING) return clamp(Math.round(BATCH / milliseconds), 1, MOST_PIECES);
    this.spared = Math.min(this.spared + SPARE * (now - this.planned), 2 * milliseconds);
    const pieces = Math.min(Math.floor(this.spared / milliseconds), MOST_PIECES);
    this.spared -= pieces * milliseconds;
    return pieces;
  }
}
