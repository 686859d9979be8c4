import { expect, test, vi } from "vitest";

import type { Block } from "../src/api/client";
import type { RecipeDocument } from "../src/api/schema";
import { Refined } from "../src/refined";

interface Question {
  readonly recipe: RecipeDocument;
  readonly small: boolean;
  readonly signal: AbortSignal;
  readonly answer: () => Promise<void>;
  readonly fail: (text: string) => Promise<void>;
}

const BLOCK: Block = { halfs: new Uint16Array(4), shape: [1, 1, 1, 4], scale: [1, 1, 1] };

function of(a: number): RecipeDocument {
  return { library: "small", blend: "lobes", weights: { a, b: 1 - a } };
}

/** A table of a mix, the questions that it asks, and what it tells. */
function asked() {
  const questions: Question[] = [];
  const came: boolean[] = [];
  const told = { behind: false, problem: null as string | null };
  const settle = () => vi.advanceTimersByTimeAsync(0);
  const table = new Refined<RecipeDocument, Block>({
    ask: (recipe, small, signal) =>
      new Promise((resolve, reject) => {
        const answer = () => {
          resolve(BLOCK);
          return settle().then(() => {});
        };
        const fail = (text: string) => {
          reject(new Error(text));
          return settle().then(() => {});
        };
        questions.push({ recipe, small, signal, answer, fail });
      }),
    onAnswer: (_, small) => came.push(small),
    onBehind: (behind) => {
      told.behind = behind;
    },
    onProblem: (problem) => {
      told.problem = problem;
    },
  });
  return { table, questions, came, told };
}

test("while something moves the latest is asked for next, and nothing between", async () => {
  vi.useFakeTimers();
  const { table, questions, came, told } = asked();
  for (const a of [0.1, 0.2, 0.3]) table.want(of(a));
  expect(questions.map(({ recipe }) => recipe)).toEqual([of(0.1)]);
  await questions[0]!.answer();
  expect(questions.map(({ recipe }) => recipe)).toEqual([of(0.1), of(0.3)]);
  // What came is drawn although it is not the last: a dragged picture goes on.
  expect(came).toEqual([true]);
  expect(told.behind).toBe(true);
});

test("when nothing moves the full table follows, once", async () => {
  vi.useFakeTimers();
  const { table, questions, came, told } = asked();
  table.want(of(0.5));
  await questions[0]!.answer();
  await vi.advanceTimersByTimeAsync(1000);
  expect(questions.map(({ small }) => small)).toEqual([true, false]);
  await questions[1]!.answer();
  expect(came).toEqual([true, false]);
  expect(told.behind).toBe(false);
  table.want(of(0.5));
  await vi.advanceTimersByTimeAsync(1000);
  expect(questions).toHaveLength(2);
});

test("a full table that something moved away from is taken back, and never shown", async () => {
  vi.useFakeTimers();
  const { table, questions, came } = asked();
  table.want(of(0.5));
  await questions[0]!.answer();
  await vi.advanceTimersByTimeAsync(1000);
  table.want(of(0.6));
  expect(questions[1]!.signal.aborted).toBe(true);
  await questions[1]!.answer();
  expect(came).toEqual([true]);
  expect(questions[2]).toMatchObject({ recipe: of(0.6), small: true });
});

test("while another question is awaited the full table waits, and is taken back", async () => {
  vi.useFakeTimers();
  const { table, questions, came, told } = asked();
  table.want(of(0.5), true);
  await questions[0]!.answer();
  await vi.advanceTimersByTimeAsync(1000);
  expect(questions).toHaveLength(1);
  table.want(of(0.5));
  await vi.advanceTimersByTimeAsync(1000);
  expect(questions[1]!.small).toBe(false);
  table.want(of(0.5), true);
  expect(questions[1]!.signal.aborted).toBe(true);
  table.want(of(0.5));
  await questions[1]!.answer();
  await vi.advanceTimersByTimeAsync(1000);
  await questions[2]!.answer();
  expect(came).toEqual([true, false]);
  expect(told.behind).toBe(false);
});

test("a failure is said, and the next change asks again", async () => {
  vi.useFakeTimers();
  const { table, questions, told } = asked();
  table.want(of(0.5));
  await questions[0]!.fail("no such material");
  expect(told.problem).toBe("no such material");
  table.want(of(0.6));
  await questions[1]!.answer();
  expect(told.problem).toBeNull();
});
