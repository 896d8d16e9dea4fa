import { action } from "../actions";
import { command } from "../link";
import { blocked, model, name_of, saved_states } from "../state";

export function Keyframes() {
  const keyframes = model.value?.keyframes ?? [];
  return (
    <>
      {keyframes.map((_, i) => {
        const name = name_of(keyframes, i, "keyframe");
        return (
          <div class="row" key={i}>
            <span class="name">{name}</span>
            <button disabled={!!blocked.value} title={blocked.value || `Set the state to ${name}`} data-testid={`load-keyframe-${i}`}
              onClick={() => command({ type: "load_keyframe", keyframe: i })}>Load</button>
          </div>
        );
      })}
      {saved_states.value.map(({ name, text }, i) => (
        <div class="row" key={name + i}>
          <span class="name">{name}</span>
          <button disabled={!!blocked.value} title={blocked.value} onClick={() => command({ type: "paste_state", text })}>Load</button>
          <button aria-label={`Remove ${name}`} onClick={() => { saved_states.value = saved_states.value.filter((_, k) => k !== i); }}>×</button>
        </div>
      ))}
      <div class="row buttons">
        <button id="save-state" title="Keep the present state in this list (Ctrl + S)" onClick={action("save-state").run}>Save</button>
        <button id="copy-state" title="Copy the state as a <key> element of MJCF (Ctrl + C)" onClick={action("copy-state").run}>Copy</button>
        <button id="paste-state" disabled={!!blocked.value} title={blocked.value || "Set the state to a copied <key> element (Ctrl + V)"}
          onClick={action("paste-state").run}>Paste</button>
      </div>
    </>
  );
}
