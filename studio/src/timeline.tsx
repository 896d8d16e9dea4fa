import { useSignal } from "@preact/signals";
import { play_backwards, seek } from "./actions";
import { blocked, hello, is_log, state } from "./state";

/** Time of a log, or the recent past of a simulation. */
export function Timeline() {
  const backwards = useSignal(false);
  const now = state.value;
  const first = is_log.value ? 0 : now?.history_start ?? 0, last = is_log.value ? hello.value!.log_end : now?.time ?? 0;
  const empty = last - first < 1e-9;
  return (
    <div class="timeline" id="timeline">
      {is_log.value && (
        <button id="reverse" aria-pressed={backwards.value} disabled={!!blocked.value} title={blocked.value || "Play backwards"}
          onClick={() => { backwards.value = play_backwards(!backwards.value); }}>Reverse</button>
      )}
      <span class="caption">{is_log.value ? "Log" : "History"}</span>
      <output>{first.toFixed(2)} s</output>
      <input id="seek" type="range" min={first} max={empty ? first + 1 : last} step="any" value={empty ? first + 1 : now?.time ?? first}
        disabled={empty || !!blocked.value} aria-label={is_log.value ? "Time in the log" : "Go back in time"}
        title={blocked.value || (is_log.value ? "Go to an instant of the log" : "Go back to an earlier instant; the simulation pauses there")}
        onInput={(event) => seek(Number(event.currentTarget.value))} />
      <output id="end">{last.toFixed(2)} s</output>
    </div>
  );
}
