import { expect, test } from "vitest";

import { Later } from "../src/api/client";
import { read } from "../src/api/http";

/** An answer of eight bytes of which four come, and then an error. */
function broken(error: Error): Response {
  const body = new ReadableStream({
    start: (controller) => controller.enqueue(new Uint8Array(4)),
    pull: (controller) => controller.error(error),
  });
  return new Response(body, { headers: { "Content-Length": "8" } });
}

test("an answer that breaks off is asked for again", async () => {
  const shares: number[] = [];
  const reading = read(broken(new TypeError("network error")), (share) => shares.push(share));
  await expect(reading).rejects.toThrow(Later);
  await expect(reading).rejects.toThrow(/broke off on its way/);
  expect(shares).toEqual([0.5]);
});

test("an answer that is no longer wanted is none", async () => {
  const reading = read(broken(new DOMException("", "AbortError")), () => {});
  await expect(reading).rejects.toThrow(DOMException);
});
