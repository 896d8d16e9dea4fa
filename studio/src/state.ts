import { computed, signal } from "@preact/signals";
import type { Hello, Model, State } from "./protocol";

// The state that the server sent last, and the state of this page. Settings that outlive the page are in settings.ts.

export type LinkState = "connecting" | "live" | "lost" | "ended";
export const link_state = signal<LinkState>("connecting");
/** Reason of a lost connection. */
export const link_problem = signal("");
export const hello = signal<Hello | null>(null);
export const state = signal<State | null>(null);
export const model = signal<Model | null>(null);

export const live = computed(() => link_state.value === "live" && state.value !== null);
export const paused = computed(() => state.value?.paused ?? true);
export const speed = computed(() => state.value?.speed ?? 1);
export const camera = computed(() => state.value?.camera ?? "");
export const serial = computed(() => state.value?.serial ?? -1);
export const run = computed(() => state.value?.run ?? 0);
export const is_log = computed(() => (hello.value?.log_end ?? 0) > 0);
export const in_control = computed(() => live.value && state.value!.controller === hello.value?.client);

/** Why this page may not change the simulation; empty if it may. */
export const blocked = computed(() => {
  if (!live.value) return "Not connected";
  if (in_control.value) return "";
  return state.value!.controller === 0 ? "Nobody is in control. Press “Take control” first."
    : "Another window is in control. Press “Take control” first.";
});

export interface Selection { id: number; name: string }
export const selection = signal<Selection | null>(null);
/** Panels list only elements of the selected body. */
export const only_selected = signal(false);
export const help_open = signal(false);

export interface SavedState { name: string; text: string }
/** States that the user saved in this page. */
export const saved_states = signal<SavedState[]>([]);
/** Newest copied state, for pasting where the clipboard is not readable. */
export const copied_state = signal("");

/** Name of an element, or its kind and index if the model gives none. */
export function name_of(names: readonly string[] | undefined, index: number, kind: string): string {
  return names?.[index] || `${kind} ${index}`;
}

// ---- notices ----

export const notice = signal("");
let notice_timer = 0;

/** Shows a text for a few seconds. */
export function show_notice(text: string, seconds = 4) {
  notice.value = text;
  clearTimeout(notice_timer);
  notice_timer = window.setTimeout(hide_notice, 1000 * seconds);
}

export function hide_notice() {
  notice.value = "";
}
