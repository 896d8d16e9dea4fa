import { useSignal } from "@preact/signals";

export interface NumberFieldProps {
  label: string;
  value: number;
  low?: number;
  high?: number;
  digits?: number;
  /** Why it cannot be changed; empty if it can. */
  blocked?: string;
  set: (value: number) => void;
}

/** A number that the simulation changes. While the user types, the text is the user's; a number out of range is not accepted. */
export function NumberField({ label, value, low = -Infinity, high = Infinity, digits = 3, blocked = "", set }: NumberFieldProps) {
  const draft = useSignal<string | null>(null);
  const commit = (text: string) => {
    const next = Number(text);
    if (text.trim() !== "" && Number.isFinite(next) && next >= low && next <= high) set(next);
    draft.value = null;
  };
  return (
    <input type="number" step="any" min={Number.isFinite(low) ? low : undefined} max={Number.isFinite(high) ? high : undefined}
      value={draft.value ?? value.toFixed(digits)} disabled={!!blocked} title={blocked} aria-label={label}
      onInput={(event) => { draft.value = event.currentTarget.value; }} onChange={(event) => commit(event.currentTarget.value)}
      onBlur={() => { draft.value = null; }}
      onKeyDown={(event) => { if (event.key === "Escape") draft.value = null; }} />
  );
}
