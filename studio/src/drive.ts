import { effect, signal } from "@preact/signals";
import { send } from "./link";
import { in_control } from "./state";

// Driving a robot with the keyboard or a gamepad. Goals are sent ten times per second while driving is on, and a zero goal when it ends, so
// that a robot never keeps a velocity that nobody holds.

/** Index of the driven robot, or null. */
export const driving = signal<number | null>(null);
export const drive_speed = signal(0.5);  // [m/s] at full deflection
export const drive_turn = signal(1);  // [rad/s] at full deflection
export interface DriveGoal { vx: number; vy: number; yaw_rate: number; vz: number }
const kZero: DriveGoal = { vx: 0, vy: 0, yaw_rate: 0, vz: 0 };
export const drive_goal = signal<DriveGoal>(kZero);
export const gamepad_name = signal("");

const kPeriod = 100;  // [ms]
const kDeadZone = 0.12;
const kKeys = ["KeyW", "KeyA", "KeyS", "KeyD", "KeyQ", "KeyE", "KeyR", "KeyF"];
const held = new Set<string>();

/** Notes a key that was pressed or released; returns whether driving uses it. */
export function drive_key(code: string, down: boolean): boolean {
  if (!kKeys.includes(code)) return false;
  if (down) held.add(code);
  else held.delete(code);
  return true;
}

function axis(positive: string, negative: string) {
  return Number(held.has(positive)) - Number(held.has(negative));
}

function stick(value: number | undefined) {
  return value === undefined || Math.abs(value) < kDeadZone ? 0 : -value;
}

function goal(): DriveGoal {
  const pad = navigator.getGamepads?.().find((each) => each?.connected) ?? null;
  gamepad_name.value = pad?.id ?? "";
  const limit = (value: number, scale: number) => Math.max(-1, Math.min(1, value)) * scale;
  return {
    vx: limit(axis("KeyW", "KeyS") + stick(pad?.axes[1]), drive_speed.value),
    vy: limit(axis("KeyQ", "KeyE") + stick(pad?.axes[0]), drive_speed.value),
    yaw_rate: limit(axis("KeyA", "KeyD") + stick(pad?.axes[2]), drive_turn.value),
    vz: limit(axis("KeyR", "KeyF") + stick(pad?.axes[3]), drive_speed.value),
  };
}

function stop() {
  held.clear();
  if (driving.value !== null) send({ type: "drive", robot: driving.value, ...kZero });
  drive_goal.value = kZero;
}

export function start_driving() {
  let timer = 0, robot: number | null = null;
  effect(() => {
    clearInterval(timer);
    if (robot !== null && driving.value !== robot) send({ type: "drive", robot, ...kZero });
    robot = driving.value;
    drive_goal.value = kZero;
    if (robot === null) return;
    const driven = robot;
    timer = window.setInterval(() => {
      drive_goal.value = goal();
      send({ type: "drive", robot: driven, ...drive_goal.peek() });
    }, kPeriod);
  });
  effect(() => { if (!in_control.value) driving.value = null; });
  window.addEventListener("blur", stop);
  document.addEventListener("visibilitychange", () => { if (document.hidden) stop(); });
}
