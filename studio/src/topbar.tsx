import { action, kActions, key_text, show_camera } from "./actions";
import { blocked, camera, hello, in_control, live, paused, speed, state } from "./state";
import { Icon } from "./widgets/icon";
import { recording } from "./view/capture";

export function TopBar() {
  return (
    <div class="bar" role="toolbar" aria-label="Simulation">
      <span class="brand"><img src="/icon.svg" alt="" width="20" height="20" />{hello.value?.title || "Gloam"}</span>
      <div class="group">
        <IconButton id="reset" icon="reset" />
        <IconButton id="back" icon="back" />
        <button id="play" class="primary" disabled={!!blocked.value} title={blocked.value || "Play or pause (Space)"} onClick={action("play").run}>
          <Icon name={paused.value ? "play" : "pause"} />{paused.value ? "Play" : "Pause"}
        </button>
        <IconButton id="step" icon="step" />
      </div>
      <div class="group" role="group" aria-label="Speed">
        <IconButton id="slower" icon="minus" />
        <output id="speed" title="Requested speed in simulated seconds per second">{speed.value}×</output>
        <IconButton id="faster" icon="plus" />
      </div>
      <CameraList />
      <span class="space" />
      <Ownership />
      <div class="group">
        <button id="record" class={recording.value ? "recording" : ""} title="Record a video of the view (Ctrl + R)" aria-label="Record video"
          aria-pressed={recording.value} onClick={action("record").run}><Icon name="record" /></button>
        <IconButton id="screenshot" icon="camera" />
        <IconButton id="theme" icon="theme" />
        <IconButton id="help-button" icon="help" />
      </div>
    </div>
  );
}

/** A button for an action; one that needs control is disabled, with the reason as its tooltip, while another client has it. */
function IconButton({ id, icon }: { id: string; icon: string }) {
  const { label, keys, run, control } = kActions.find((each) => each.id === id)!;
  const reason = control ? blocked.value : "";
  const title = keys.length ? `${label} (${key_text(keys[0])})` : label;
  return <button id={id} aria-label={label} title={reason || title} disabled={!!reason} onClick={run}><Icon name={icon} /></button>;
}

function CameraList() {
  return (
    <label class="group">
      <span class="caption">Camera</span>
      <select id="camera" value={camera.value} disabled={!!blocked.value} title={blocked.value || "Camera ([ and ], Esc for the free one)"}
        onChange={(event) => show_camera(event.currentTarget.value)}>
        {(hello.value?.cameras ?? []).map((name) => <option key={name} value={name}>{name}</option>)}
      </select>
    </label>
  );
}

function Ownership() {
  if (!live.value) return null;
  const others = state.value!.clients - 1;
  const watching = others > 0 ? `${others} other ${others === 1 ? "window" : "windows"}` : "";
  return (
    <div class="group">
      <span id="role" class="quiet">{in_control.value ? watching && `In control, with ${watching}` : "Watching"}</span>
      {!in_control.value && <button id="claim" class="accent" onClick={action("claim").run}>Take control</button>}
      {in_control.value && others > 0 && <button id="release" onClick={action("release").run}>Release</button>}
    </div>
  );
}
