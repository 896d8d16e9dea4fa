import { useEffect, useRef } from "preact/hooks";
import { draw_here, overlays_on, show_info } from "../settings";
import { camera, link_state, notice, selection, state } from "../state";
import { project } from "./camera";
import { attach_canvas, image } from "./images";
import { gesture_kind, image_box, listen_to_mouse, pull, select } from "./mouse";
import { ViewportLayer } from "../viewport/layer";

/** The image of the server, with the overlays that the browser draws on top. */
export function Stage() {
  const stage = useRef<HTMLElement>(null), canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    attach_canvas(canvas.current);
    return listen_to_mouse(stage.current!);
  }, []);
  const offline = link_state.value !== "live";
  return (
    <main id="stage" ref={stage} tabIndex={0} class={`${gesture_kind.value} ${offline ? "offline" : ""}`}
      aria-label="Image of the simulation. Drag to turn the free camera; F1 lists all keys.">
      <canvas id="picture" ref={canvas} width="4" height="3" hidden={draw_here.value} />
      {(draw_here.value || overlays_on.value.length > 0) && <ViewportLayer />}
      <PullLine />
      {!image.value && !draw_here.value && <Placeholder />}
      {selection.value && (
        <p id="selected" class="chip">{selection.value.name}
          <button aria-label="Clear the selection" onClick={() => select(-1)}>×</button></p>
      )}
      {show_info.value && <Info />}
      {notice.value && <p id="notice" class="toast" role="status">{notice.value}</p>}
    </main>
  );
}

function Placeholder() {
  const texts = { connecting: "Connecting…", live: "Waiting for the first image…", lost: "Connection lost", ended: "Ended" };
  const busy = link_state.value === "connecting" || link_state.value === "live";
  return <p id="placeholder">{busy && <span class="spinner" aria-hidden="true" />}{texts[link_state.value]}</p>;
}

function Info() {
  const now = state.value, shown = image.value;
  if (!now) return null;
  return (
    <pre id="info">{[
      `time     ${now.time.toFixed(3)} s, step ${now.step}`,
      `camera   ${camera.value}`,
      shown && `image    ${shown.width} × ${shown.height} at ${shown.time.toFixed(3)} s`,
      shown && `position ${shown.position.map((value) => value.toFixed(3)).join(" ")} m`,
      selection.value && `selected ${selection.value.name} (body ${selection.value.id})`,
    ].filter(Boolean).join("\n")}</pre>
  );
}

/** From the grabbed point to the mouse. */
function PullLine() {
  const held = pull.value, shown = image.value, stage = document.getElementById("stage");
  if (!held?.point || !shown || !stage) return null;
  const box = image_box(stage), from = project(shown, held.point);
  if (!from) return null;
  const x = (u: number) => box.left + box.scale * u, y = (v: number) => box.top + box.scale * v;
  const line = { x1: x(from.u), y1: y(from.v), x2: x(held.u * shown.width / held.width), y2: y(held.v * shown.width / held.width) };
  return (
    <svg id="overlay" class="on" aria-hidden="true">
      <line class="shadow" {...line} /><line {...line} />
      <circle cx={line.x1} cy={line.y1} r="4" /><circle class="ring" cx={line.x2} cy={line.y2} r="6" />
    </svg>
  );
}
