import { signal } from "@preact/signals";
import { command, handle, send } from "../link";
import type { Vector } from "../protocol";
import { draw_here } from "../settings";
import { blocked, camera, hide_notice, in_control, live, name_of, model, selection, show_notice } from "../state";
import { image } from "./images";

// Mouse and touch on the view: gestures become messages, or moves of the local camera while the browser draws the scene.

/** A body that the mouse pulls: pixel of the mouse, and the grabbed point once the server has found it. */
export interface Pull { u: number; v: number; width: number; turn: boolean; point: Vector | null }
export const pull = signal<Pull | null>(null);
export const gesture_kind = signal("");

/** The camera of client-side drawing; the viewport provides it. */
export interface LocalCamera {
  orbit(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
  zoom(amount: number): void;
  /** Body and point at a position in [−1, 1]². */
  pick(x: number, y: number): { body: number; point: Vector } | null;
  look_at(point: Vector): void;
}
let local: LocalCamera | null = null;
export function set_local_camera(camera: LocalCamera | null) { local = camera; }

const kClickTravel = 3;  // [CSS px] that a hand may shake
const kDoubleClick = 350;  // [ms]

interface Gesture { kind: "orbit" | "pan" | "pull"; x: number; y: number; moved: boolean; id: number }
let stage: HTMLElement;
let gesture: Gesture | null = null;
let travel = { kind: "orbit" as "orbit" | "pan", dx: 0, dy: 0 };
let zoom = 0, pull_moved = false, flush_queued = false, last_right_click = 0, track_next = false;

/** Position and scale of the image in the stage; object-fit leaves margins. */
export function image_box(element: HTMLElement) {
  const width = image.value?.width ?? 4, height = image.value?.height ?? 3;
  const scale = Math.min(element.clientWidth / width, element.clientHeight / height);
  return { scale, width, height, left: (element.clientWidth - scale * width) / 2, top: (element.clientHeight - scale * height) / 2 };
}

function pixel(event: MouseEvent) {
  const box = image_box(stage), at = stage.getBoundingClientRect();
  return { u: (event.clientX - at.left - box.left) / box.scale, v: (event.clientY - at.top - box.top) / box.scale, width: box.width };
}

function in_image({ u, v }: { u: number; v: number }) {
  return image.value !== null && u >= 0 && v >= 0 && u < image.value.width && v < image.value.height;
}

// Moves are gathered and sent once per refresh of the screen; the server needs no more.
function queue_flush() {
  if (flush_queued) return;
  flush_queued = true;
  requestAnimationFrame(flush);
}

function flush() {
  flush_queued = false;
  const { kind, dx, dy } = travel, amount = Math.max(-10, Math.min(10, zoom));
  travel = { kind, dx: 0, dy: 0 };
  zoom = 0;
  if (dx || dy) draw_here.value ? local?.[kind](dx, dy) : send({ type: kind, dx, dy });
  if (amount) draw_here.value ? local?.zoom(amount) : send({ type: "zoom", amount });
  if (pull_moved && pull.value) send({ type: "drag_move", u: pull.value.u, v: pull.value.v, width: pull.value.width });
  pull_moved = false;
}

/** True if the free camera may move; otherwise a notice gives the reason. */
function camera_may_move(): boolean {
  if (draw_here.value) return true;
  if (!in_control.value) show_notice(blocked.value);
  else if (camera.value !== "free") show_notice("This camera belongs to the model. Press Esc for the free camera.");
  return in_control.value && camera.value === "free";
}

function start_pull(event: PointerEvent): boolean {
  const at = pixel(event);
  if (draw_here.value) show_notice("Bodies are pulled in the server's image. Turn off “Draw here” first.");
  else if (!in_control.value) show_notice(blocked.value);
  if (draw_here.value || !in_control.value || !in_image(at)) return false;
  const turn = event.button === 0;
  pull.value = { ...at, turn, point: null };
  send({ type: "drag_start", ...at, turn });
  return true;
}

function on_down(event: PointerEvent) {
  stage.focus({ preventScroll: true });
  if (gesture || event.button === 1 || !live.value) return;
  event.preventDefault();
  if (event.button === 2 && is_second_right_click(event)) return on_right_double_click(event);
  const kind = event.ctrlKey ? "pull" : event.button === 2 || event.shiftKey ? "pan" : "orbit";
  if (kind === "pull" && !start_pull(event)) return;
  gesture = { kind, x: event.clientX, y: event.clientY, moved: false, id: event.pointerId };
  if (kind === "pull") gesture_kind.value = kind;
  stage.setPointerCapture(event.pointerId);
}

function on_move(event: PointerEvent) {
  if (!gesture || event.pointerId !== gesture.id) return;
  if (gesture.kind === "pull") {
    if (!pull.value) return;
    pull.value = { ...pull.value, ...pixel(event) };
    pull_moved = true;
    return queue_flush();
  }
  const dx = event.clientX - gesture.x, dy = event.clientY - gesture.y;
  if (!gesture.moved) {
    if (Math.hypot(dx, dy) < kClickTravel) return;
    if (!camera_may_move()) {
      gesture = null;
      return;
    }
    gesture.moved = true;
    last_right_click = 0;
    gesture_kind.value = gesture.kind;
  }
  if (travel.kind !== gesture.kind) flush();
  const box = image_box(stage), height = draw_here.value ? stage.clientHeight : box.scale * box.height;
  travel = { kind: gesture.kind, dx: travel.dx + dx / height, dy: travel.dy + dy / height };
  gesture = { ...gesture, x: event.clientX, y: event.clientY };
  queue_flush();
}

function end_gesture() {
  gesture = null;
  flush();
  gesture_kind.value = "";
  end_pull();
}

export function end_pull() {
  if (!pull.value) return;
  pull.value = null;
  send({ type: "drag_end" });
  hide_notice();
}

// ---- clicks ----

function is_second_right_click(event: PointerEvent): boolean {
  const second = event.timeStamp - last_right_click < kDoubleClick;
  last_right_click = second ? 0 : event.timeStamp;
  return second;
}

function local_pick(event: MouseEvent) {
  const at = stage.getBoundingClientRect();
  return local?.pick(2 * (event.clientX - at.left) / at.width - 1, 1 - 2 * (event.clientY - at.top) / at.height) ?? null;
}

function on_double_click(event: MouseEvent) {
  if (draw_here.value) return select(local_pick(event)?.body ?? -1);
  const at = pixel(event);
  if (in_image(at)) send({ type: "pick", ...at });
}

function on_right_double_click(event: PointerEvent) {
  if (draw_here.value) {
    const found = local_pick(event);
    if (found) local?.look_at(found.point);
    return;
  }
  const at = pixel(event);
  if (!in_image(at) || !camera_may_move()) return;
  if (event.ctrlKey) {
    track_next = true;
    send({ type: "pick", ...at });
  } else {
    command({ type: "look_at", ...at });
  }
}

export function select(id: number, name = "") {
  selection.value = id < 0 ? null : { id, name: name || name_of(model.value?.bodies, id, "body") };
}

handle({
  picked: ({ found, body, id, point, dragging }) => {
    if (dragging) {
      if (pull.value) pull.value = { ...pull.value, point: point! };
      return show_notice(`${pull.value?.turn ? "Turning" : "Pulling"} ${name_of([body!], 0, "a body without a name,")}`);
    }
    select(found ? id! : -1, body);
    if (track_next) command({ type: "track", body: found ? id! : -1 });
    if (track_next && found) show_notice(`The camera follows ${selection.value!.name}.`);
    track_next = false;
  },
  pulled: ({ point }) => { if (pull.value?.point) pull.value = { ...pull.value, point }; },
  notice: ({ text }) => {
    if (!pull.value || pull.value.point) return;
    end_pull();
    show_notice(text);
  },
});

export function listen_to_mouse(element: HTMLElement): () => void {
  stage = element;
  const end = (event: PointerEvent) => { if (gesture && event.pointerId === gesture.id) end_gesture(); };
  const wheel = (event: WheelEvent) => {
    event.preventDefault();
    if (!live.value || !camera_may_move()) return;
    zoom -= 0.15 * event.deltaY / [100, 3, 1][event.deltaMode];  // a notch is about 100 px, 3 lines or 1 page
    queue_flush();
  };
  const stop = (event: Event) => event.preventDefault();
  const listeners: [string, (event: never) => void][] = [
    ["pointerdown", on_down], ["pointermove", on_move], ["pointerup", end], ["pointercancel", end], ["lostpointercapture", end],
    ["dblclick", on_double_click], ["wheel", wheel], ["contextmenu", stop],
  ];
  for (const [name, listener] of listeners) element.addEventListener(name, listener as EventListener, { passive: false });
  return () => { for (const [name, listener] of listeners) element.removeEventListener(name, listener as EventListener); };
}
