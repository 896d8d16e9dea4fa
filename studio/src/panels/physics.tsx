import { use_model, use_watch } from "../fields";
import { hello, model } from "../state";

/** Options and sizes, as `simulate` shows them. */
export function Physics() {
  const [gravity, wind, timestep] = use_watch("opt.gravity", "opt.wind", "opt.timestep");
  const [mass] = use_model("body_mass");
  const vector = (values: Float32Array) => values.length ? [...values].map((value) => value.toFixed(2)).join(" ") : "–";
  const total = mass.value.reduce((sum, value) => sum + value, 0);
  const rows: [string, string][] = [
    ["Gravity", `${vector(gravity.value)} m/s²`],
    ["Wind", `${vector(wind.value)} m/s`],
    ["Timestep", timestep.value.length ? `${(1000 * timestep.value[0]).toPrecision(3)} ms` : `${hello.value ? 1000 / hello.value.step_rate : "–"} ms`],
    ["Total mass", `${total.toPrecision(4)} kg`],
    ["Bodies, geoms", `${model.value?.bodies.length ?? "–"}, ${model.value?.geoms.length ?? "–"}`],
    ["Joints, actuators", `${model.value?.joints.length ?? "–"}, ${model.value?.actuators.length ?? "–"}`],
    ["Sensors, tendons", `${model.value?.sensors.length ?? "–"}, ${model.value?.tendons.length ?? "–"}`],
  ];
  return <dl class="facts">{rows.map(([name, value]) => <div key={name}><dt>{name}</dt><dd>{value}</dd></div>)}</dl>;
}
