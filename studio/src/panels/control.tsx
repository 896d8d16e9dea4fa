import { computed, type ReadonlySignal } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { use_model, use_watch } from "../fields";
import { command } from "../link";
import { blocked, model, name_of } from "../state";
import { use_filter } from "../widgets/filter";
import { Empty } from "../widgets/section";
import { Slider } from "../widgets/slider";

const kMost = 60;

export function Control() {
  const [limited, ranges, addresses] = use_model("actuator_ctrllimited", "actuator_ctrlrange", "actuator_ctrladr");
  const [ctrl] = use_watch("ctrl");
  const names = model.value?.actuators ?? [];
  const { field, shown, more } = use_filter(names.map((_, i) => ({ i, name: name_of(names, i, "actuator") })), kMost);
  if (!names.length) return <Empty text="This model has no actuators." />;
  return (
    <>
      {field}
      <div class="row buttons">
        <button id="clear-controls" disabled={!!blocked.value} title={blocked.value || "Set all controls to 0"} onClick={() => command({ type: "clear_controls" })}>Clear all</button>
      </div>
      {shown.map(({ i, name }) => {
        const has_range = limited.value[i] > 0, [low, high] = has_range ? [ranges.value[2 * i], ranges.value[2 * i + 1]] : [-1, 1];
        return <OneControl key={i} actuator={i} name={name} low={low} high={high} address={addresses.value[i] ?? i} ctrl={ctrl} />;
      })}
      {more}
    </>
  );
}

function OneControl({ actuator, name, low, high, address, ctrl }:
  { actuator: number; name: string; low: number; high: number; address: number; ctrl: ReadonlySignal<Float32Array> }) {
  const value = useMemo(() => computed(() => ctrl.value[address] ?? 0), [ctrl, address]);
  return <Slider label={name} value={value} low={low} high={high} blocked={blocked.value} testid={`control-${actuator}`}
    set={(next) => command({ type: "set_control", actuator, value: next })} />;
}
