import { computed, useSignal, type ReadonlySignal } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { use_model, use_watch } from "../fields";
import { command } from "../link";
import { blocked, model, name_of } from "../state";
import { Empty } from "../widgets/section";
import { Slider } from "../widgets/slider";
import { Filter } from "./joints";

const kMost = 60;

export function Control() {
  const filter = useSignal("");
  const [limited, ranges, addresses] = use_model("actuator_ctrllimited", "actuator_ctrlrange", "actuator_ctrladr");
  const [ctrl] = use_watch("ctrl");
  const names = model.value?.actuators ?? [];
  if (!names.length) return <Empty text="This model has no actuators." />;
  const wanted = names.map((_, i) => ({ i, name: name_of(names, i, "actuator") })).filter(({ name }) => name.toLowerCase().includes(filter.value.toLowerCase()));
  return (
    <>
      <Filter filter={filter} />
      <div class="row buttons">
        <button id="clear-controls" disabled={!!blocked.value} title={blocked.value || "Set all controls to 0"} onClick={() => command({ type: "clear_controls" })}>Clear all</button>
      </div>
      {wanted.slice(0, kMost).map(({ i, name }) => {
        const has_range = limited.value[i] > 0, [low, high] = has_range ? [ranges.value[2 * i], ranges.value[2 * i + 1]] : [-1, 1];
        return <OneControl key={i} actuator={i} name={name} low={low} high={high} address={addresses.value[i] ?? i} ctrl={ctrl} />;
      })}
      {wanted.length > kMost && <p class="hint">{wanted.length - kMost} more: type a part of the name.</p>}
    </>
  );
}

function OneControl({ actuator, name, low, high, address, ctrl }:
  { actuator: number; name: string; low: number; high: number; address: number; ctrl: ReadonlySignal<Float32Array> }) {
  const value = useMemo(() => computed(() => ctrl.value[address] ?? 0), [ctrl, address]);
  return <Slider label={name} value={value} low={low} high={high} blocked={blocked.value} testid={`control-${actuator}`}
    set={(next) => command({ type: "set_control", actuator, value: next })} />;
}
