import { command, command_with, handle, send } from "./link";
import { overlay_actions } from "./overlays";
import { draw_here, left_open, open_sections, right_open, show_info, theme, type Theme } from "./settings";
import { camera, copied_state, hello, help_open, is_log, live, paused, saved_states, selection, show_notice, speed, state } from "./state";
import { save_screenshot, toggle_recording } from "./view/capture";

// Every action of the user, once. Buttons, menus, keys and the list under F1 come from kActions.

export interface Action {
  id: string;
  label: string;
  group: "Run" | "View" | "Panels" | "State" | "Overlays" | "Groups" | "Window";
  /** Keys as in KeyboardEvent.key, with "Ctrl+" and "Shift+" in this order. */
  keys: string[];
  /** True for actions that only the client in control may run. */
  control?: boolean;
  /** True if a held key repeats the action. */
  repeats?: boolean;
  run: () => void;
}

const kSpeeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50];
const kReverseBeat = 0.1;  // wall seconds between two instants of a log that is played backwards

function change_speed(by: number) {
  const distance = (value: number) => Math.abs(Math.log(value / speed.value));
  const near = kSpeeds.reduce((best, value, i) => distance(value) < distance(kSpeeds[best]) ? i : best, 0);
  const value = kSpeeds[Math.max(0, Math.min(kSpeeds.length - 1, near + by))];
  command_with({ type: "speed", value }, { speed: value });
}

export function show_camera(name: string) {
  command_with({ type: "camera", name }, { camera: name });
}

function change_camera(by: number) {
  const cameras = hello.value?.cameras ?? [];
  if (!cameras.length) return;
  const at = Math.max(0, cameras.indexOf(camera.value));
  show_camera(cameras[(at + by + cameras.length) % cameras.length]);
}

function play_or_pause() {
  play_backwards(false);
  if (live.value) command_with({ type: paused.value ? "resume" : "pause" }, { paused: !paused.value });
}

function step(count: number) {
  if (is_log.value) seek(state.value!.time + count / (hello.value!.step_rate || 100));
  else command(count > 0 ? { type: "step", count } : { type: "back", count: -count });
}

export function seek(time: number) {
  const now = state.value;
  if (!now) return;
  const [first, last] = is_log.value ? [0, hello.value!.log_end] : [now.history_start, now.time];
  command({ type: "seek", time: Math.max(first, Math.min(last, time)) });
}

// ---- a log played backwards ----

let reverse_timer = 0;

export function play_backwards(on: boolean): boolean {
  clearInterval(reverse_timer);
  reverse_timer = 0;
  if (!on || !state.value || !command({ type: "pause" })) return false;
  let time = state.value.time;
  reverse_timer = window.setInterval(() => {
    time -= kReverseBeat * speed.value;
    seek(time);
    if (time <= 0 || !live.value) play_backwards(false);
  }, 1000 * kReverseBeat);
  return true;
}

// ---- states ----

let use_copied: ((text: string) => void) | null = null;
handle({ copied: ({ text }) => {
  use_copied?.(text);
  use_copied = null;
} });

function copy_state() {
  use_copied = (text) => {
    copied_state.value = text;
    navigator.clipboard?.writeText(text).catch(() => {});
    show_notice("The state is in the clipboard.");
  };
  send({ type: "copy_state" });
}

async function paste_state() {
  let text = copied_state.value;
  try {
    text = (await navigator.clipboard.readText()) || text;
  } catch {
    // Without permission to read the clipboard, the state that this page copied is pasted.
  }
  if (text) {
    if (command({ type: "paste_state", text })) show_notice("The state is that of the clipboard.");
  } else show_notice("The clipboard contains no state. Copy one first.");
}

function save_state() {
  const time = state.value?.time ?? 0;
  use_copied = (text) => {
    saved_states.value = [...saved_states.value, { name: `State at ${time.toFixed(3)} s`, text }];
    show_notice("The state is in the list of the Keyframes panel.");
  };
  send({ type: "copy_state" });
}

// ---- the page ----

function toggle_section(title: string, side: typeof left_open) {
  const open = open_sections.value.includes(title);
  open_sections.value = open && side.value ? open_sections.value.filter((other) => other !== title)
    : [...open_sections.value.filter((other) => other !== title), title];
  side.value = true;
}

function next_theme() {
  const themes: Theme[] = ["auto", "dark", "light"];
  theme.value = themes[(themes.indexOf(theme.value) + 1) % themes.length];
}

function full_screen() {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.documentElement.requestFullscreen().catch(() => show_notice("This browser does not allow full screen here."));
}

export const kActions: readonly Action[] = [
  { id: "reset", label: "Reset", group: "Run", keys: ["Backspace"], control: true, run: () => command({ type: "reset" }) },
  { id: "back", label: "Step back", group: "Run", keys: ["ArrowLeft"], control: true, repeats: true, run: () => step(-1) },
  { id: "back10", label: "10 steps back", group: "Run", keys: ["Shift+ArrowLeft"], control: true, repeats: true, run: () => step(-10) },
  { id: "play", label: "Play or pause", group: "Run", keys: [" "], control: true, run: play_or_pause },
  { id: "step", label: "Step", group: "Run", keys: ["ArrowRight"], control: true, repeats: true, run: () => step(1) },
  { id: "step10", label: "10 steps", group: "Run", keys: ["Shift+ArrowRight"], control: true, repeats: true, run: () => step(10) },
  { id: "slower", label: "Slower", group: "Run", keys: ["-"], control: true, run: () => change_speed(-1) },
  { id: "faster", label: "Faster", group: "Run", keys: ["=", "+"], control: true, run: () => change_speed(1) },
  { id: "claim", label: "Take control", group: "Run", keys: [], run: () => send({ type: "claim" }) },
  { id: "release", label: "Release control", group: "Run", keys: [], control: true, run: () => command({ type: "release" }) },

  { id: "camera-free", label: "Free camera", group: "View", keys: ["Escape"], control: true, run: escape },
  { id: "camera-previous", label: "Previous camera", group: "View", keys: ["["], control: true, run: () => change_camera(-1) },
  { id: "camera-next", label: "Next camera", group: "View", keys: ["]"], control: true, run: () => change_camera(1) },
  { id: "draw-here", label: "Draw here", group: "View", keys: ["w"], run: () => { draw_here.value = !draw_here.value; } },
  { id: "screenshot", label: "Save screenshot", group: "View", keys: ["Ctrl+p"], run: save_screenshot },
  { id: "record", label: "Record video", group: "View", keys: ["Ctrl+r"], run: toggle_recording },

  { id: "copy-state", label: "Copy state", group: "State", keys: ["Ctrl+c"], run: copy_state },
  { id: "paste-state", label: "Paste state", group: "State", keys: ["Ctrl+v"], control: true, run: paste_state },
  { id: "save-state", label: "Save state in the list", group: "State", keys: ["Ctrl+s"], run: save_state },

  { id: "left-panel", label: "Left panel", group: "Panels", keys: ["Tab"], run: () => { left_open.value = !left_open.value; } },
  { id: "right-panel", label: "Right panel", group: "Panels", keys: ["Shift+Tab"], run: () => { right_open.value = !right_open.value; } },
  { id: "help-button", label: "Keys and mouse", group: "Panels", keys: ["F1", "?"], run: () => { help_open.value = !help_open.value; } },
  { id: "info", label: "Information over the image", group: "Panels", keys: ["F2"], run: () => { show_info.value = !show_info.value; } },
  { id: "profiler", label: "Profiler", group: "Panels", keys: ["F3"], run: () => toggle_section("Profiler", right_open) },
  { id: "sensors", label: "Sensors", group: "Panels", keys: ["F4"], run: () => toggle_section("Sensors", right_open) },

  { id: "full-screen", label: "Full screen", group: "Window", keys: ["F5"], run: full_screen },
  { id: "theme", label: "Next theme", group: "Window", keys: [], run: next_theme },
  ...overlay_actions,
];

function escape() {
  if (selection.value) selection.value = null;
  if (camera.value !== "free") show_camera("free");
}

export function action(id: string): Action {
  return kActions.find((each) => each.id === id)!;
}

export const kGestures: readonly [string, string][] = [
  ["Left drag", "turns the free camera"],
  ["Right drag, Shift + left drag", "moves the free camera sideways"],
  ["Wheel", "moves the camera closer or farther"],
  ["Double click", "selects a body"],
  ["Right double click", "moves the pivot of the camera to a point"],
  ["Ctrl + right double click", "follows a body"],
  ["Ctrl + left drag", "turns a body"],
  ["Ctrl + right drag", "pulls a body"],
];

/** A key as it is printed on keyboards. */
export function key_text(key: string): string {
  const names: Record<string, string> = { " ": "Space", ArrowLeft: "←", ArrowRight: "→", Escape: "Esc", "-": "−" };
  return key.split("+").map((part, i, all) => part === "" ? (i === all.length - 1 ? "+" : "") : names[part] ?? (part.length === 1 ? part.toUpperCase() : part))
    .filter(Boolean).join(" + ");
}
