import { computed, type ReadonlySignal } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { use_model, use_watch } from "../fields";
import { command } from "../link";
import { blocked, model, name_of } from "../state";
import { use_filter } from "../widgets/filter";
import { NumberField } from "../widgets/number_field";
import { Empty } from "../widgets/section";
import { Slider } from "../widgets/slider";

const kFree = 0, kBall = 1, kSlide = 2;  // mjtJoint
const kWidths = [7, 4, 1, 1];  // numbers in qpos
const kParts = { [kFree]: ["x", "y", "z", "qw", "qx", "qy", "qz"], [kBall]: ["qw", "qx", "qy", "qz"] } as Record<number, string[]>;
const kMost = 60;  // rows; more are found by the filter

interface Row { joint: number; name: string; type: number; address: number; low: number; high: number; body: number }

export function Joints() {
  const [types, addresses, limited, ranges, bodies] = use_model("jnt_type", "jnt_qposadr", "jnt_limited", "jnt_range", "jnt_bodyid");
  const [qpos] = use_watch("qpos");
  const names = model.value?.joints ?? [];
  const rows: Row[] = [...types.value].map((type, joint) => ({
    joint, type, name: name_of(names, joint, "joint"), address: addresses.value[joint], body: bodies.value[joint],
    low: limited.value[joint] ? ranges.value[2 * joint] : type === kSlide ? -1 : -Math.PI,
    high: limited.value[joint] ? ranges.value[2 * joint + 1] : type === kSlide ? 1 : Math.PI,
  }));
  const { field, shown, more } = use_filter(rows, kMost);
  if (!names.length) return <Empty text="This model has no joints." />;
  return (
    <>
      {field}
      {shown.map((row) => row.type in kParts ? <Numbers key={row.joint} row={row} qpos={qpos} /> : <OneNumber key={row.joint} row={row} qpos={qpos} />)}
      {more}
      {!shown.length && <Empty text="No joint has this name." />}
    </>
  );
}

function OneNumber({ row, qpos }: { row: Row; qpos: ReadonlySignal<Float32Array> }) {
  const value = useMemo(() => computed(() => qpos.value[row.address] ?? 0), [qpos, row.address]);
  return (
    <Slider label={row.name} unit={row.type === kSlide ? "m" : "rad"} value={value} low={row.low} high={row.high} blocked={blocked.value} testid={`joint-${row.joint}`}
      set={(next) => command({ type: "set_joint", joint: row.joint, qpos: [next] })} />
  );
}

/** A free or ball joint: its numbers in qpos. */
function Numbers({ row, qpos }: { row: Row; qpos: ReadonlySignal<Float32Array> }) {
  const width = kWidths[row.type];
  const present = () => Array.from({ length: width }, (_, k) => qpos.value[row.address + k] ?? 0);
  return (
    <fieldset class="numbers-of" data-testid={`joint-${row.joint}`}>
      <legend>{row.name}</legend>
      {kParts[row.type].map((part, k) => (
        <label key={part}><span>{part}</span>
          <NumberField label={`${row.name} ${part}`} value={qpos.value[row.address + k] ?? 0} blocked={blocked.value}
            set={(value) => {
              const next = present();
              next[k] = value;
              command({ type: "set_joint", joint: row.joint, qpos: next });
            }} />
        </label>
      ))}
    </fieldset>
  );
}
