import { hello, link_state, paused, state } from "./state";
import { image_rate, missed } from "./view/images";

const kLinkTexts = { connecting: "Connecting", live: "Connected", lost: "Connection lost", ended: "Ended" };

export function StatusBar() {
  const now = state.value;
  return (
    <footer class="status" aria-label="Status">
      <dl>
        <Cell id="time" name="Time" value={now ? `${now.time.toFixed(3)} s` : "–"} />
        <Cell id="steps" name="Step" value={now ? now.step.toLocaleString("en") : "–"} tip={hello.value ? `${hello.value.step_rate} steps per second` : ""} />
        <Cell id="factor" name="Real time" value={!now ? "–" : paused.value ? "paused" : `${now.realtime_factor.toFixed(2)}×`}
          tip="Measured simulated seconds per second" />
        <Cell id="rate" name="Images" value={`${image_rate.value}/s`} tip="Images shown in the last second" />
        <Cell id="dropped" name="Dropped" value={`${(now?.dropped ?? 0) + missed.value}`}
          tip="Images that were not rendered or not sent because something was too slow" />
        {!!now?.warnings && <Cell id="warnings" name="Warnings" value={`${now.warnings}`} tip="Warnings of the physics engine since the start" />}
        <Cell id="hash" name="State" value={now?.hash ?? "–"} tip="Hash of the states of all steps so far: equal runs have equal hashes" />
      </dl>
      <span id="link" class="link" data-state={link_state.value}><i aria-hidden="true" /><span id="link-text">{kLinkTexts[link_state.value]}</span></span>
    </footer>
  );
}

function Cell({ id, name, value, tip }: { id: string; name: string; value: string; tip?: string }) {
  return <div title={tip}><dt>{name}</dt><dd id={id}>{value}</dd></div>;
}
