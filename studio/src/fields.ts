import { effect, signal, type ReadonlySignal, type Signal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import { connection, handle_fields, send } from "./link";
import type { FieldReply } from "./protocol";
import { serial, show_notice } from "./state";

// MuJoCo's arrays. Constant ones are requested once per model; changing ones are watched while a panel or overlay needs them. The watches
// of all panels are merged into one message.

export const kEmpty = new Float32Array(0);
const kMaxFields = 64;
const kRate = 20;  // [1/s]

// ---- constants of the model ----

const constants = new Map<string, Signal<Float32Array>>();
const waiting = new Map<number, string[]>();
let wanted = new Set<string>();
let next_id = 1;

/** A field of the model, empty until it arrives. */
export function model_field(name: string): ReadonlySignal<Float32Array> {
  let found = constants.get(name);
  if (!found) {
    found = signal(kEmpty);
    constants.set(name, found);
    request(name);
  }
  return found;
}

function request(name: string) {
  if (wanted.size === 0) queueMicrotask(send_requests);
  wanted.add(name);
}

function send_requests() {
  const names = [...wanted];
  wanted = new Set();
  for (let i = 0; i < names.length; i += kMaxFields) {
    const fields = names.slice(i, i + kMaxFields), id = next_id++;
    waiting.set(id, fields);
    send({ type: "get", id, fields });
  }
}

// A new connection or a changed model makes all constants out of date.
effect(() => {
  if (connection.value === 0 || serial.value < 0) return;
  for (const name of constants.keys()) request(name);
});

// ---- watched fields ----

const values = new Map<string, Signal<Float32Array>>();
const users = new Map<string, number>();
/** Counts replies with constants of the model. */
export const constants_count = signal(0);
/** Counts replies to the watch. */
export const watch_count = signal(0);
let sent = "";
let update_queued = false;

function value_signal(name: string) {
  let found = values.get(name);
  if (!found) values.set(name, found = signal(kEmpty));
  return found;
}

/** The newest values of a watched field. */
export function live_field(name: string): ReadonlySignal<Float32Array> { return value_signal(name); }

/** Watches fields until the returned function is called. */
export function watch(names: readonly string[]): () => void {
  for (const name of names) users.set(name, (users.get(name) ?? 0) + 1);
  queue_update();
  return () => {
    for (const name of names) {
      const left = users.get(name)! - 1;
      if (left > 0) users.set(name, left);
      else users.delete(name);
    }
    queue_update();
  };
}

function queue_update() {
  if (update_queued) return;
  update_queued = true;
  window.setTimeout(update_watch, 30);  // panels that close and open together cause one message
}

function update_watch() {
  update_queued = false;
  let names = [...users.keys()].sort();
  if (names.length > kMaxFields) {
    show_notice(`The panels need ${names.length} fields; only ${kMaxFields} can be watched at a time. Close a panel.`);
    names = names.slice(0, kMaxFields);
  }
  const text = names.join(" ");
  if (text === sent) return;
  sent = text;
  send({ type: "watch", fields: names, rate: kRate });
}

effect(() => {
  if (connection.value === 0) return;
  sent = "";
  if (users.size > 0) queue_update();
});

handle_fields((reply: FieldReply) => {
  if (reply.id === 0) {
    for (const [name, numbers] of reply.values) value_signal(name).value = numbers;
    watch_count.value++;
    return;
  }
  for (const name of waiting.get(reply.id) ?? []) {
    const found = constants.get(name);
    if (found) found.value = reply.values.get(name) ?? kEmpty;
  }
  waiting.delete(reply.id);
  constants_count.value++;
});

// ---- hooks of panels ----

/** Watches fields while the component is shown. */
export function use_watch(...names: string[]): ReadonlySignal<Float32Array>[] {
  const key = names.join(" ");
  useEffect(() => watch(names), [key]);
  return useMemo(() => names.map(live_field), [key]);
}

export function use_model(...names: string[]): ReadonlySignal<Float32Array>[] {
  return useMemo(() => names.map(model_field), [names.join(" ")]);
}
