import { kActions, type Action } from "./actions";
import { driving, drive_key } from "./drive";
import { help_open } from "./state";

// Keys of the page. A focused widget keeps the keys that it uses itself.

const by_key = new Map<string, Action>(kActions.flatMap((each) => each.keys.map((key): [string, Action] => [key, each])));

function key_name(event: KeyboardEvent): string {
  // Shift + digit is a punctuation mark that depends on the keyboard; the code of the key does not.
  const digit = event.shiftKey && /^Digit[0-5]$/.test(event.code) ? event.code.slice(5) : "";
  const key = digit || (event.key.length === 1 ? event.key.toLowerCase() : event.key);
  const shift = event.shiftKey && (digit || key.length > 1) ? "Shift+" : "";
  return (event.ctrlKey || event.metaKey ? "Ctrl+" : "") + shift + key;
}

/** True if the focused element uses this key. */
function belongs_to_widget(event: KeyboardEvent, name: string): boolean {
  const target = event.target as HTMLElement;
  if (target.closest("#stage") || target === document.body) return false;
  // Inside panels, Tab moves the focus, so that the page is usable with a keyboard only.
  if (name.endsWith("Tab")) return true;
  if (/^F\d/.test(name) || name === "Escape" || name === "Ctrl+p") return false;
  if (target.matches("input:not([type=range]):not([type=checkbox]), textarea, [contenteditable]")) return true;
  if (target.matches("select, input[type=range], [role=tab], [role=separator]")) return name !== " " && !name.startsWith("Ctrl+");
  return target.matches("button, summary, input[type=checkbox], a") && (name === " " || name === "Enter");
}

function on_key_down(event: KeyboardEvent) {
  const name = key_name(event);
  if (event.altKey || (help_open.value && name !== "F1" && name !== "?")) return;
  if (belongs_to_widget(event, name)) return;
  if (driving.value && !event.ctrlKey && drive_key(event.code, true)) return event.preventDefault();
  const found = by_key.get(name);
  if (!found || (name === "Ctrl+c" && !getSelection()?.isCollapsed)) return;
  event.preventDefault();
  if (!event.repeat || found.repeats) found.run();
}

export function listen_to_keys() {
  document.addEventListener("keydown", on_key_down);
  document.addEventListener("keyup", (event) => drive_key(event.code, false));
}
