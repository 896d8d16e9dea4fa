import type { ImageHeader } from "../protocol";

// H.264 by WebCodecs. Each packet gives one picture, in order.

const kCodec = "avc1.640033";  // High profile, level 5.1
const kPatience = 15_000;  // [ms] until a decoder that gives no picture counts as failed

export function can_decode_video(): boolean {
  return typeof VideoDecoder !== "undefined";
}

export class VideoDecoding {
  private decoder: VideoDecoder | null = null;
  private waiting: { resolve: (picture: VideoFrame) => void; reject: (error: unknown) => void } | null = null;

  /** The picture of a packet; null for one that needs an earlier packet which this page has not received. */
  async decode(header: ImageHeader, packet: Uint8Array<ArrayBuffer>): Promise<VideoFrame | null> {
    if (header.key && !this.decoder) this.open();
    if (!this.decoder) return null;
    const picture = new Promise<VideoFrame>((resolve, reject) => { this.waiting = { resolve, reject }; });
    const timer = window.setTimeout(() => this.fail(new Error("the decoder gives no picture")), kPatience);
    this.decoder.decode(new EncodedVideoChunk({ type: header.key ? "key" : "delta", timestamp: Number(header.sequence), data: packet }));
    try {
      return await picture;
    } finally {
      clearTimeout(timer);
    }
  }

  private open() {
    this.decoder = new VideoDecoder({ output: (picture) => this.waiting?.resolve(picture), error: (error) => this.fail(error) });
    this.decoder.configure({ codec: kCodec, optimizeForLatency: true });
  }

  private fail(error: unknown) {
    if (this.decoder?.state !== "closed") this.decoder?.close();
    this.decoder = null;
    this.waiting?.reject(error);
  }
}
