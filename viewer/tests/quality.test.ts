import { expect, test } from "vitest";

import { Quality, SAMPLES_TO_SHOW } from "../src/render/quality";

const TARGET = 384;
const SECOND = 1000;

/** A page and its card, in numbers: what of `LivePicture` and `Painter` the quality has to do with. */
class Machine {
  readonly quality = new Quality();
  time = 0;
  /** What the page is to show, and what a person sees: the number of the last change. */
  change = 0;
  private canvas = -1;
  private cover = -1;
  private covered = false;
  private names: readonly string[] = ["a", "b"];
  private work = new Map<string, number>();
  private scale = 1;
  private doneAt = 0;
  private log: { at: number; shows: number }[] = [];

  constructor(
    /** Milliseconds of a pass over the whole picture. */
    readonly cost: number,
    readonly options: { guess?: number; frame?: number; tick?: number } = {},
  ) {
    this.quality.sized(1e6);
    this.quality.turnTo("sphere");
    this.quality.measured(options.guess ?? cost);
    this.changeView();
  }

  changeView(): void {
    this.change++;
    this.quality.viewChanged(this.now, this.names.length);
    this.work.clear();
  }

  changeMaterial(names: readonly string[] = this.names): void {
    this.change++;
    this.names = names;
    this.quality.materialChanged(this.now);
  }

  /** Frame after frame for so long, or until something holds. */
  run(milliseconds: number, until = () => false): void {
    const end = this.time + milliseconds;
    while (this.time < end && !until()) {
      this.frame();
      this.time += this.options.frame ?? 16;
    }
  }

  /** The change that a person sees now. */
  get seen(): number {
    return this.log.filter(({ at }) => at <= this.time).at(-1)?.shows ?? -1;
  }

  get isSettled(): boolean {
    return this.quality.settled(this.needed);
  }

  get isCovered(): boolean {
    return this.covered;
  }

  get needed() {
    const samples = this.names.map((name) => this.of(name));
    const unseen = samples.filter((n) => n === 0).length;
    return { count: samples.length, unseen, fewest: Math.min(...samples), target: TARGET };
  }

  private get now(): number {
    const { tick = 0 } = this.options;
    return tick ? tick * Math.floor(this.time / tick) : this.time;
  }

  private frame(): void {
    const { quality } = this;
    quality.asked(this.time >= this.doneAt, this.now);
    const { pieces, piece, target } = quality.plan(this.now, this.needed);
    expect(pieces).toSatisfy((n: number) => Number.isInteger(n) && n >= 0 && n <= 64);
    if (quality.scale !== this.scale) this.resize();
    const passes = this.improve(pieces, piece, target);
    if (passes > 0) {
      this.doneAt = Math.max(this.time, this.doneAt) + passes * this.cost * this.scale ** 2;
      quality.began(passes, this.now);
    }
    if (this.needed.fewest > 0) this.canvas = this.change;
    this.covered = quality.covers(this.canvas >= 0, this.needed);
    // The card shows what it was told last when it is done with what it was told before.
    const shows = this.covered ? this.cover : this.canvas;
    this.log.push({ at: Math.max(this.time, this.doneAt), shows });
  }

  private resize(): void {
    this.scale = this.quality.scale;
    if (!this.covered) this.cover = this.canvas;
    this.covered = true;
    this.canvas = -1;
    this.work.clear();
  }

  private improve(pieces: number, piece: number, target: number): number {
    for (let i = 0; i < pieces; i++) {
      const [least] = [...this.names].sort((a, b) => this.of(a) - this.of(b));
      if (this.of(least!) >= target) return i * piece;
      this.work.set(least!, (this.work.get(least!) ?? 0) + piece);
    }
    return pieces * piece;
  }

  /** The whole samples of a material. */
  private of(name: string): number {
    return Math.floor((this.work.get(name) ?? 0) + 1e-9);
  }
}

/** From a card that draws 10,000 pictures a second to a processor that takes 6 s for one. */
const COSTS = [0.1, 5, 39, 60, 300, 1500, 6000];
const OTHERS = ["c", "d", "e", "f", "g", "h", "i", "j"];

function expectChangeSeen(machine: Machine, what: string): void {
  machine.run(SECOND);
  expect(machine.seen, `${what}, a pass of ${machine.cost} ms`).toBe(machine.change);
}

test.each(COSTS)("a change is seen within a second, whenever it comes: a pass takes %d ms", (cost) => {
  for (const frame of [16, 120]) {
    for (const pause of [0, 300, 900, 2000, 4000, 10_000, 30_000]) {
      const machine = new Machine(cost, { frame });
      expectChangeSeen(machine, "the first picture");
      machine.run(pause);
      machine.changeMaterial();
      expectChangeSeen(machine, `other weights after ${pause} ms`);
      machine.run(pause);
      machine.changeMaterial([...OTHERS, "a"]);
      expectChangeSeen(machine, `other materials after ${pause} ms`);
      machine.run(pause);
      machine.changeView();
      expectChangeSeen(machine, `another view after ${pause} ms`);
    }
  }
});

test.each(COSTS)("while t is dragged what is seen is never a second old: a pass takes %d ms", (cost) => {
  const machine = new Machine(cost);
  machine.run(5000);
  for (let step = 0; step < 100; step++) {
    const before = machine.change;
    // A new material comes in now and then, and one goes.
    machine.changeMaterial(["a", `crossed ${Math.floor(step / 12)}`, `crossed ${Math.floor(step / 20)}`]);
    machine.run(50);
    if (step >= 20) expect(machine.seen).toBeGreaterThanOrEqual(before - 20);
  }
  expectChangeSeen(machine, "the last step");
});

test("a fast card draws whole pictures only, and settles within a second", () => {
  const machine = new Machine(0.1);
  for (let i = 0; i < 10; i++) {
    machine.run(200);
    machine.changeView();
    expect(machine.quality.scale).toBe(1);
  }
  machine.run(SECOND);
  expect(machine.isSettled).toBe(true);
});

test("one cold pass is not taken for the cost of all", () => {
  const machine = new Machine(0.1, { guess: 25 * 0.1 });
  machine.run(SECOND);
  expect(machine.isSettled).toBe(true);
  const slow = new Machine(0.5, { guess: 1000 });
  expect(slow.quality.scale).toBeLessThan(0.3);
  slow.run(2 * SECOND);
  expect(slow.isSettled).toBe(true);
});

test("a card that is slower than it seemed is learnt", () => {
  const machine = new Machine(600, { guess: 24 });
  machine.run(10 * SECOND);
  machine.changeMaterial(OTHERS);
  expectChangeSeen(machine, "after ten seconds");
});

test.each([1, 20, 100])("a clock that ticks every %d ms stops nothing", (tick) => {
  for (const cost of [0.01, 0.5, 60, 1500]) {
    const machine = new Machine(cost, { tick, guess: 0 });
    machine.run(20 * SECOND);
    machine.changeMaterial(OTHERS);
    expectChangeSeen(machine, "other materials");
    machine.run(120 * SECOND, () => machine.isSettled);
    if (cost < 1) expect(machine.isSettled).toBe(true);
    expect(machine.needed.fewest).toBeGreaterThan(0);
  }
});

test("the whole picture comes under the small one, and out when it is the less noisy", () => {
  const machine = new Machine(100);
  machine.run(SECOND);
  expect(machine.quality.isSmall).toBe(true);
  machine.run(20 * SECOND, () => !machine.quality.isSmall);
  while (machine.isCovered) {
    expect(machine.seen).toBe(machine.change);
    machine.run(16);
  }
  expect(machine.quality.isSmall).toBe(false);
  expect(machine.needed.fewest).toBeGreaterThanOrEqual(SAMPLES_TO_SHOW);
  // Weights of materials that have their samples change in the whole picture.
  machine.changeMaterial();
  machine.run(100);
  expect(machine.quality.isSmall).toBe(false);
  expect(machine.isCovered).toBe(false);
  machine.run(200 * SECOND, () => machine.isSettled);
  expect(machine.isSettled).toBe(true);
});

test("while something moves, most of the time is left to it", () => {
  const machine = new Machine(20);
  machine.run(5000);
  let passes = 0;
  for (let step = 0; step < 60; step++) {
    const before = machine.needed.fewest;
    machine.changeMaterial();
    machine.run(16);
    passes += machine.needed.fewest - before;
  }
  // Of a second a tenth is 5 passes of 20 ms, between two materials.
  expect(passes).toBeLessThanOrEqual(5);
});
