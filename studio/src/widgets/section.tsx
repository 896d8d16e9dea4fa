import type { ComponentType } from "preact";
import { open_sections, toggle_in } from "../settings";

/** A part of a panel that can be folded. Its body exists only while it is open, so that closed sections request nothing. */
export function Section({ title, tip, body: Body }: { title: string; tip: string; body: ComponentType }) {
  const open = open_sections.value.includes(title);
  const id = title.toLowerCase().replace(/\W+/g, "-");
  return (
    <section class="section" data-testid={`section-${id}`}>
      <h2><button class="fold" aria-expanded={open} aria-controls={`body-${id}`} title={tip}
        onClick={() => { open_sections.value = toggle_in(open_sections.value, title); }}>{title}</button></h2>
      {open && <div id={`body-${id}`} class="body"><Body /></div>}
    </section>
  );
}

export function Empty({ text }: { text: string }) {
  return <p class="empty">{text}</p>;
}
