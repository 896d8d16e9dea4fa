import type { Signal } from "@preact/signals";
import type { ComponentType } from "preact";
import { Section } from "./section";

export interface Panel { title: string; tip: string; body: ComponentType }

const kNarrowest = 200, kWidest = 640;  // [px]

/** A column of sections at one side of the view, which can be folded and resized. */
export function SidePanel({ side, open, width, panels }: { side: "left" | "right"; open: Signal<boolean>; width: Signal<number>; panels: readonly Panel[] }) {
  if (!open.value) return null;
  const resize = (by: number) => { width.value = Math.min(kWidest, Math.max(kNarrowest, width.value + (side === "left" ? by : -by))); };
  const on_key = (event: KeyboardEvent) => {
    if (event.key === "ArrowLeft") resize(-16);
    else if (event.key === "ArrowRight") resize(16);
  };
  const on_drag = (event: PointerEvent) => { if (event.buttons & 1) resize(event.movementX); };
  const handle = (
    <div class="splitter" role="separator" tabIndex={0} aria-orientation="vertical" aria-label={`Width of the ${side} panel`} aria-valuenow={width.value}
      aria-valuemin={kNarrowest} aria-valuemax={kWidest} onKeyDown={on_key} onPointerMove={on_drag}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)} />
  );
  return (
    <>
      {side === "right" && handle}
      <aside id={`${side}-panel`} class="side" aria-label={side === "left" ? "Simulation and view" : "State and measurements"} style={{ width: `${width.value}px` }}>
        {panels.map(({ title, tip, body }) => <Section key={title} title={title} tip={tip} body={body} />)}
      </aside>
      {side === "left" && handle}
    </>
  );
}
