import { signal } from "@preact/signals";
import { hello, show_notice, state } from "../state";

// Screenshots and videos of the view: the image with the overlays on top, in the resolution of the screen.

export const recording = signal(false);
const kRate = 30;  // [1/s]
let recorder: MediaRecorder | null = null;

/** Canvases of the view, lowest first. */
function layers(): HTMLCanvasElement[] {
  return [...document.querySelectorAll<HTMLCanvasElement>("#stage canvas")].filter((each) => !each.hidden && each.width > 0);
}

/** Draws all layers into one canvas of the size of the largest one. */
function compose(target: HTMLCanvasElement) {
  const context = target.getContext("2d")!;
  context.fillStyle = "#0e0f11";
  context.fillRect(0, 0, target.width, target.height);
  for (const layer of layers()) context.drawImage(layer, 0, 0, target.width, target.height);
}

function composed_canvas() {
  const canvas = document.createElement("canvas");
  canvas.width = Math.max(2, ...layers().map((each) => each.width));
  canvas.height = Math.max(2, ...layers().map((each) => each.height));
  compose(canvas);
  return canvas;
}

function download(blob: Blob, extension: string) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  const title = (hello.value?.title || "gloam").replace(/\W+/g, "_");
  link.download = `${title}_${(state.value?.time ?? 0).toFixed(3)}s.${extension}`;
  link.click();
  window.setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export function save_screenshot() {
  // Overlays are drawn for the screenshot, because WebGL discards its canvas after each frame.
  document.dispatchEvent(new Event("redraw_view"));
  composed_canvas().toBlob((blob) => { if (blob) download(blob, "png"); }, "image/png");
}

export function toggle_recording() {
  if (recorder) return recorder.stop();
  const type = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((each) => window.MediaRecorder?.isTypeSupported(each));
  if (!type) return show_notice("This browser cannot record videos.");
  const canvas = composed_canvas(), chunks: Blob[] = [];
  recorder = new MediaRecorder(canvas.captureStream(kRate), { mimeType: type, videoBitsPerSecond: 8_000_000 });
  const timer = window.setInterval(() => {
    document.dispatchEvent(new Event("redraw_view"));
    compose(canvas);
  }, 1000 / kRate);
  recorder.ondataavailable = ({ data }) => chunks.push(data);
  recorder.onstop = () => {
    clearInterval(timer);
    recorder = null;
    recording.value = false;
    download(new Blob(chunks, { type }), "webm");
  };
  recorder.start(1000);
  recording.value = true;
}
