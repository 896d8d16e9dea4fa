import { computed, effect, signal } from "@preact/signals";
import { connection, handle, handle_images, send } from "../link";
import type { ImageHeader } from "../protocol";
import { draw_here } from "../settings";
import { state } from "../state";
import { can_decode_video, VideoDecoding } from "./video";

// Images of the server. They are decoded one after the other, so that none overtakes another, and acknowledged after they are drawn.

/** Header of the displayed image. */
export const image = signal<ImageHeader | null>(null);
/** Images that the server numbered but did not send to this page. */
export const missed = signal(0);

const arrivals: number[] = [];  // [ms], times of the images of the last second
export const image_rate = computed(() => {
  state.value;  // ten times per second
  const now = performance.now();
  while (arrivals.length && arrivals[0] < now - 1000) arrivals.shift();
  return arrivals.length;
});

let canvas: HTMLCanvasElement | null = null;
let last_sequence = 0n;
let queue = Promise.resolve();
const video = new VideoDecoding();
let owed = 0;  // acknowledgements that are held back while the browser draws the scene itself

export function attach_canvas(element: HTMLCanvasElement | null) { canvas = element; }

handle({ hello: () => {
  last_sequence = 0n;
  owed = 0;
} });
handle_images((header, coded) => { queue = queue.then(() => show(header, coded)).catch(() => {}); });

effect(() => {
  if (connection.value > 0 && can_decode_video()) send({ type: "codec", name: "h264" });
});

/** A picture that the canvas can draw, or null where a packet of video gave none. */
async function decode(header: ImageHeader, coded: Uint8Array<ArrayBuffer>): Promise<ImageBitmap | VideoFrame | null> {
  if (!header.h264) return createImageBitmap(new Blob([coded], { type: "image/jpeg" }));
  try {
    return await video.decode(header, coded);
  } catch {  // this browser's decoder does not take the stream
    send({ type: "codec", name: "jpeg" });
    return null;
  }
}

async function show(header: ImageHeader, coded: Uint8Array<ArrayBuffer>) {
  if (last_sequence !== 0n && header.sequence > last_sequence) missed.value += Number(header.sequence - last_sequence) - 1;
  last_sequence = header.sequence;
  try {
    const picture = await decode(header, coded);
    if (!picture) return;
    if (canvas) {
      if (canvas.width !== header.width || canvas.height !== header.height) {
        canvas.width = header.width;
        canvas.height = header.height;
      }
      canvas.getContext("2d", { alpha: false })!.drawImage(picture, 0, 0);
    }
    picture.close();
  } finally {
    acknowledge();
  }
  arrivals.push(performance.now());
  image.value = header;
}

/** Acknowledges an image. Without acknowledgements the server stops sending, which frees a slow link while the browser draws. */
function acknowledge() {
  if (draw_here.value) owed++;
  else send({ type: "seen" });
}

effect(() => {
  if (draw_here.value) return;
  for (; owed > 0; owed--) send({ type: "seen" });
});
