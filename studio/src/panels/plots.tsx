import { computed } from "@preact/signals";
import { use_model, use_watch } from "../fields";
import { plotted_sensors, watched } from "../settings";
import { model, name_of } from "../state";
import { Plot, type Line } from "../widgets/plot";

const kMostLines = 8;

export function Plots() {
  const fields = [...new Set(["energy", "sensordata", ...watched.value.filter(({ plot }) => plot).map(({ field }) => field)])];
  const live = use_watch(...fields);
  const [addresses, sizes] = use_model("sensor_adr", "sensor_dim");
  const value = (field: string, index: number) => live[fields.indexOf(field)]?.value[index] ?? NaN;
  const energy: Line[] = [
    { label: "potential", read: () => value("energy", 0) },
    { label: "kinetic", read: () => value("energy", 1) },
  ];
  const sensors: Line[] = plotted_sensors.value.flatMap((sensor) => Array.from({ length: sizes.value[sensor] ?? 0 }, (_, k): Line => ({
    label: name_of(model.value?.sensors, sensor, "sensor") + (sizes.value[sensor] > 1 ? ` ${k}` : ""),
    read: () => value("sensordata", addresses.value[sensor] + k),
  })));
  const numbers: Line[] = watched.value.filter(({ plot }) => plot).map(({ field, index }) => ({ label: `${field}[${index}]`, read: () => value(field, index) }));
  const chosen = [...sensors, ...numbers];
  const version = computed(() => live.map((each) => each.value.length).join());
  return (
    <>
      <Plot title="Energy [J]" lines={energy} />
      {chosen.length > 0 && <Plot key={chosen.map(({ label }) => label).join() + version.value} title="Chosen numbers" lines={chosen.slice(0, kMostLines)} />}
      {chosen.length > kMostLines && <p class="hint">The first {kMostLines} of {chosen.length} are drawn.</p>}
      {!chosen.length && <p class="hint">Tick numbers in Sensors or Watch to draw them here.</p>}
    </>
  );
}
