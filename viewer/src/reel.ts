// Where the frames of a film go: a video, where the browser encodes one, or a zip of pictures.

import { Zip, ZipPassThrough } from "three/addons/libs/fflate.module.js";

export interface Reel {
  readonly suffix: string;
  readonly add: (frame: OffscreenCanvas, seconds: number, duration: number) => Promise<void>;
  readonly end: () => Promise<Blob>;
}

/** A video, in what most programs read first; null where the browser encodes none. */
export async function videoReel(size: number, rate: number): Promise<Reel | null> {
  if (!("VideoEncoder" in globalThis)) return null;
  // A fifth of the page, that few need.
  return (await import("./video")).encodedReel(size, rate);
}

/** A zip of PNG files, in their order by name. */
export function framesReel(): Reel {
  const parts: Uint8Array<ArrayBuffer>[] = [];
  const zip = new Zip((_, chunk) => parts.push(chunk as Uint8Array<ArrayBuffer>));
  let n = 0;
  return {
    suffix: "-frames.zip",
    add: async (frame) => {
      const picture = await frame.convertToBlob();
      const file = new ZipPassThrough(`${String(n++).padStart(4, "0")}.png`);
      zip.add(file);
      file.push(new Uint8Array(await picture.arrayBuffer()), true);
    },
    end: async () => {
      zip.end();
      return new Blob(parts, { type: "application/zip" });
    },
  };
}
