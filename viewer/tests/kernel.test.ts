import { expect, test } from "vitest";

import { Problem } from "../src/api/client";
import { kernel, type Messenger } from "../src/api/kernel";

interface Sent {
  readonly id: number;
  readonly method: string;
  readonly path: string;
  readonly body: string | null;
}

/** A kernel that keeps what it is sent, and answers when it is told to. */
function fake() {
  const sent: Sent[] = [];
  let hear: (content: unknown, buffers: readonly DataView[]) => void = () => {};
  const messenger: Messenger = {
    send: (content) => void sent.push(content as Sent),
    on: (_, listener) => {
      hear = listener;
    },
  };
  const answer = (id: number, status: number, body: Uint8Array<ArrayBuffer>, headers = {}) =>
    hear({ id, status, headers }, [new DataView(body.buffer, body.byteOffset, body.byteLength)]);
  return { client: kernel(messenger), sent, answer };
}

const text = (value: unknown) => new TextEncoder().encode(JSON.stringify(value));

test("answers find their questions, whatever their order", async () => {
  const { client, sent, answer } = fake();
  const [first, second] = [client.spaceView("paper", "root"), client.spaceView("linear", "linear")];
  expect(sent.map(({ method, path }) => [method, path])).toEqual([
    ["GET", "api/spaces/paper?blend=root"],
    ["GET", "api/spaces/linear?blend=linear"],
  ]);
  answer(sent[1]!.id, 200, text({ name: "linear" }));
  answer(sent[0]!.id, 200, text({ name: "paper" }));
  expect([(await first).name, (await second).name]).toEqual(["paper", "linear"]);
});

test("a block is read where it stands in a shared buffer", async () => {
  const { client, sent, answer } = fake();
  const table = client.table("teflon");
  // Half floats at an odd offset.
  const shared = new Uint8Array([9, 1, 0, 2, 0, 9]).subarray(1, 5);
  answer(sent[0]!.id, 200, shared, { "halfway-shape": "2,1", "halfway-scale": "1,2,4" });
  expect(await table).toEqual({ halfs: new Uint16Array([1, 2]), shape: [2, 1], scale: [1, 2, 4] });
});

test("a mistake is Python's own line", async () => {
  const { client, sent, answer } = fake();
  const answered = client.at("linear", "root", [0], new AbortController().signal);
  expect(sent[0]!.body).toBe('{"space":"linear","blend":"root","point":[0]}');
  answer(sent[0]!.id, 400, text({ error: "the space has no places." }));
  await expect(answered).rejects.toEqual(new Problem("the space has no places."));
});

test("a question taken back is not answered", async () => {
  const { client, sent, answer } = fake();
  const asked = new AbortController();
  const leg = client.leg("paper", "linear", "a", "b", "uniform", asked.signal);
  asked.abort();
  await expect(leg).rejects.toThrow("aborted");
  answer(sent[0]!.id, 200, text({}));
});
