import { useSignal, type ReadonlySignal } from "@preact/signals";
import { NumberField } from "./number_field";

export interface SliderProps {
  label: string;
  unit?: string;
  value: ReadonlySignal<number>;
  low: number;
  high: number;
  /** Why it cannot be moved; empty if it can. */
  blocked?: string;
  testid?: string;
  set: (value: number) => void;
}

/** A range with an exact number beside it. While it is held, it shows the user's value instead of the simulation's. */
export function Slider({ label, unit = "", value, low, high, blocked = "", testid, set }: SliderProps) {
  const held = useSignal<number | null>(null);
  const shown = held.value ?? value.value;
  const move = (text: string) => {
    const next = Number(text);
    if (text === "" || !Number.isFinite(next)) return;
    held.value = next;
    set(next);
  };
  const release = () => { held.value = null; };
  return (
    <label class="slider" title={blocked || `${label}: ${low.toPrecision(4)} to ${high.toPrecision(4)} ${unit}`} data-testid={testid}>
      <span class="name">{label}</span>
      <input type="range" min={low} max={high} step="any" value={shown} disabled={!!blocked} aria-label={label}
        onInput={(event) => move(event.currentTarget.value)} onChange={release} onBlur={release} />
      <NumberField label={`${label}, number`} value={shown} low={low} high={high} blocked={blocked} set={set} />
      <span class="unit">{unit}</span>
    </label>
  );
}
