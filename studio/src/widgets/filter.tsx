import { useSignal } from "@preact/signals";
import { only_selected, selection } from "../state";
import { Check } from "./check";

/**
 * The items whose name contains the text of a search field; at most `most` of them, with a hint that there are more. Items that have a body
 * can be limited to the selected one.
 */
export function use_filter<Item extends { name: string; body?: number }>(items: readonly Item[], most: number) {
  const text = useSignal("");
  const chosen = items[0]?.body === undefined ? null : selection.value;
  const wanted = items.filter(({ name, body }) => name.toLowerCase().includes(text.value.toLowerCase())
    && (!chosen || !only_selected.value || body === chosen.id));
  const field = (
    <div class="row">
      <input type="search" placeholder="Filter by name" aria-label="Filter by name" value={text.value} onInput={(event) => { text.value = event.currentTarget.value; }} />
      {chosen && <Check label={`of ${chosen.name}`} tip="Only elements of the selected body" on={only_selected.value} set={(on) => { only_selected.value = on; }} />}
    </div>
  );
  const more = wanted.length > most && <p class="hint">{wanted.length - most} more: type a part of the name.</p>;
  return { field, shown: wanted.slice(0, most), more };
}
