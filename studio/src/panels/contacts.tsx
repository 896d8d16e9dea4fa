import { use_model, use_watch } from "../fields";
import { model, name_of } from "../state";
import { Empty } from "../widgets/section";

export const kContactSize = 13;  // numbers of a contact: docs/view_protocol.md
const kMost = 40;

export function Contacts() {
  const [bodies] = use_model("geom_bodyid");
  const [contact] = use_watch("contact");
  const count = contact.value.length / kContactSize;
  if (!count) return <Empty text="Nothing is in contact." />;
  const name = (geom: number) => geom < 0 ? "flex" : name_of(model.value?.bodies, bodies.value[geom] ?? 0, "body");
  const rows = Array.from({ length: count }, (_, i) => contact.value.subarray(kContactSize * i, kContactSize * (i + 1)))
    .map((c) => ({ a: name(c[0]), b: name(c[1]), force: Math.hypot(c[8], c[9], c[10]), distance: c[11] })).sort((a, b) => b.force - a.force);
  return (
    <>
      <table class="values" id="contacts">
        <thead><tr><th>Bodies</th><th>Force [N]</th><th title="Distance between the surfaces; negative: they overlap">Gap [mm]</th></tr></thead>
        <tbody>{rows.slice(0, kMost).map(({ a, b, force, distance }, i) => (
          <tr key={i}><th scope="row">{a} – {b}</th><td>{force.toFixed(2)}</td><td>{(1000 * distance).toFixed(2)}</td></tr>
        ))}</tbody>
      </table>
      {count > kMost && <p class="hint">{count - kMost} weaker contacts are not listed.</p>}
    </>
  );
}
