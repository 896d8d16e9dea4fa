import { useEffect, useRef } from "preact/hooks";
import { show_notice } from "../state";

/** The canvas that the browser draws itself. three.js is loaded when it is first needed. */
export function ViewportLayer() {
  const canvas = useRef<HTMLCanvasElement>(null), labels = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    let stop = () => {}, gone = false;
    import("./viewport").then(({ start_viewport }) => {
      if (!gone) stop = start_viewport(canvas.current!, labels.current!);
    }).catch((error: Error) => show_notice(`This browser cannot draw overlays: ${error.message}`));
    return () => {
      gone = true;
      stop();
    };
  }, []);
  return <><canvas id="viewport" ref={canvas} aria-hidden="true" /><canvas id="labels" ref={labels} aria-hidden="true" /></>;
}
