// Encoding a video in the browser (WebCodecs), frame by frame, however long one takes.

import {
  BufferTarget,
  CanvasSource,
  getFirstEncodableVideoCodec,
  Mp4OutputFormat,
  Output,
  WebMOutputFormat,
} from "mediabunny";

import type { Reel } from "./reel";

/** Bits for each pixel of a frame: grain and thin highlights stay. */
const BITS = 0.25;

/** The first of the formats that most programs read; null where the browser encodes none. */
export async function encodedReel(size: number, rate: number): Promise<Reel | null> {
  const shape = { width: size, height: size };
  const codec = await getFirstEncodableVideoCodec(["avc", "vp9", "vp8", "av1"], shape);
  if (codec === null) return null;
  const isMp4 = codec === "avc";
  const target = new BufferTarget();
  const format = isMp4 ? new Mp4OutputFormat() : new WebMOutputFormat();
  const output = new Output({ format, target });
  const canvas = new OffscreenCanvas(size, size);
  const pen = canvas.getContext("2d")!;
  const bitrate = Math.round(BITS * size * size * rate);
  const source = new CanvasSource(canvas, { codec, bitrate });
  output.addVideoTrack(source, { frameRate: rate });
  await output.start();
  return {
    suffix: isMp4 ? ".mp4" : ".webm",
    add: async (frame, seconds, duration) => {
      pen.drawImage(frame, 0, 0);
      await source.add(seconds, duration);
    },
    end: async () => {
      await output.finalize();
      return new Blob([target.buffer!], { type: isMp4 ? "video/mp4" : "video/webm" });
    },
  };
}
