import { effect, signal } from "@preact/signals";

// Settings of this browser. Each is a signal that localStorage remembers; private windows without storage use the defaults.

const kPrefix = "gloam.";

function load<T>(key: string, fallback: T): T {
  try {
    const text = localStorage.getItem(kPrefix + key);
    return text === null ? fallback : JSON.parse(text);
  } catch {
    return fallback;
  }
}

function setting<T>(key: string, fallback: T) {
  const value = signal<T>(load(key, fallback));
  effect(() => {
    const text = JSON.stringify(value.value);
    try {
      localStorage.setItem(kPrefix + key, text);
    } catch {
      // The page works without storage; it only forgets the setting.
    }
  });
  return value;
}

export type Theme = "auto" | "dark" | "light";
export const theme = setting<Theme>("theme", "auto");
export const left_open = setting("left_open", window.innerWidth > 900);
export const right_open = setting("right_open", window.innerWidth > 1100);
export const left_width = setting("left_width", 264);
export const right_width = setting("right_width", 360);
/** Titles of sections that are open. */
export const open_sections = setting<string[]>("sections", ["Visualization", "Joints", "Control"]);
/** Names of overlays that are drawn. */
export const overlays_on = setting<string[]>("overlays", []);
export const geom_groups = setting("geom_groups", [true, true, true, false, false, false]);
export const site_groups = setting("site_groups", [true, true, true, false, false, false]);
/** True while the browser draws the scene itself. */
export const draw_here = setting("draw_here", false);
/** Numbers in the Watch panel and in the plots: a field, an element of it, a label. */
export interface Watched { field: string; index: number; plot: boolean }
export const watched = setting<Watched[]>("watched", []);
export const plotted_sensors = setting<number[]>("plotted_sensors", []);
export const show_info = setting("show_info", false);

effect(() => {
  if (theme.value === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme.value;
});

export function toggle_in<T>(list: T[], item: T): T[] {
  return list.includes(item) ? list.filter((other) => other !== item) : [...list, item];
}
