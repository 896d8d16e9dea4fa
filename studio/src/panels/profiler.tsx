import { use_watch } from "../fields";
import { state } from "../state";
import { image_rate } from "../view/images";
import { Plot } from "../widgets/plot";

export function Profiler() {
  const [contacts, constraints, islands] = use_watch("ncon", "nefc", "nisland");
  return (
    <>
      <Plot title="Real-time factor" lines={[{ label: "simulation", read: () => state.peek()?.realtime_factor ?? NaN }]} />
      <Plot title="Images per second" lines={[{ label: "images", read: () => image_rate.peek() }]} />
      <Plot title="Contacts and constraints" lines={[
        { label: "contacts", read: () => contacts.peek()[0] ?? NaN },
        { label: "constraints", read: () => constraints.peek()[0] ?? NaN },
        { label: "islands", read: () => islands.peek()[0] ?? NaN },
      ]} />
    </>
  );
}
