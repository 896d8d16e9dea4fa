import { useSignal } from "@preact/signals";
import { use_watch } from "../fields";
import { watched } from "../settings";
import { Empty } from "../widgets/section";

/** Any number of any MuJoCo array. */
export function Watch() {
  const field = useSignal("qvel"), index = useSignal(0);
  const add = (event: Event) => {
    event.preventDefault();
    const name = field.value.trim();
    if (name) watched.value = [...watched.value, { field: name, index: index.value, plot: false }];
  };
  return (
    <>
      <form class="row" onSubmit={add}>
        <input id="watch-field" aria-label="Field" title="Array of mjModel or mjData, for example qvel, xpos, sensordata, opt.gravity" value={field.value}
          onInput={(event) => { field.value = event.currentTarget.value; }} />
        <input id="watch-index" type="number" min={0} step={1} aria-label="Index" value={index.value} onInput={(event) => { index.value = Number(event.currentTarget.value); }} />
        <button id="watch-add">Add</button>
      </form>
      {!watched.value.length && <Empty text="Add an array of MuJoCo and an index into it." />}
      {watched.value.map(({ field, index }, i) => <Row key={`${field} ${index} ${i}`} at={i} />)}
    </>
  );
}

function Row({ at }: { at: number }) {
  const { field, index, plot } = watched.value[at];
  const [values] = use_watch(field);
  const change = (plot: boolean) => { watched.value = watched.value.map((each, i) => i === at ? { ...each, plot } : each); };
  const value = index < values.value.length ? values.value[index].toPrecision(6) : "–";
  return (
    <div class="row">
      <span class="name">{field}[{index}]</span>
      <span class="number" data-testid={`watch-${at}`}>{value}</span>
      <input type="checkbox" aria-label={`Plot ${field}[${index}]`} title="Draw it in Plots" checked={plot} onChange={(event) => change(event.currentTarget.checked)} />
      <button aria-label={`Remove ${field}[${index}]`} onClick={() => { watched.value = watched.value.filter((_, i) => i !== at); }}>×</button>
    </div>
  );
}
