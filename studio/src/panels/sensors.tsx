import { use_model, use_watch } from "../fields";
import { plotted_sensors, toggle_in } from "../settings";
import { model, name_of } from "../state";
import { use_filter } from "../widgets/filter";
import { Empty } from "../widgets/section";

const kMost = 80;

export function Sensors() {
  const [addresses, sizes] = use_model("sensor_adr", "sensor_dim");
  const [data] = use_watch("sensordata");
  const names = model.value?.sensors ?? [];
  const { field, shown, more } = use_filter(names.map((_, i) => ({ i, name: name_of(names, i, "sensor") })), kMost);
  if (!names.length) return <Empty text="This model has no sensors." />;
  return (
    <>
      {field}
      <table class="values">
        <thead><tr><th>Sensor</th><th>Value</th><th title="Draw it in Plots">Plot</th></tr></thead>
        <tbody>{shown.map(({ i, name }) => {
          const first = addresses.value[i], values = data.value.subarray(first, first + sizes.value[i]);
          return (
            <tr key={i}>
              <th scope="row">{name}</th>
              <td data-testid={`sensor-${i}`}>{[...values].map((value) => value.toFixed(3)).join(" ") || "–"}</td>
              <td><input type="checkbox" aria-label={`Plot ${name}`} checked={plotted_sensors.value.includes(i)}
                onChange={() => { plotted_sensors.value = toggle_in(plotted_sensors.value, i); }} /></td>
            </tr>
          );
        })}</tbody>
      </table>
      {more}
    </>
  );
}
