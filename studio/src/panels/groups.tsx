import { toggle_group } from "../overlays";
import { geom_groups, site_groups } from "../settings";

export function Groups() {
  return (
    <>
      <p class="hint">Groups that overlays and “Draw here” show. Press 0 to 5, with Shift for sites.</p>
      <GroupRow kind="geom" groups={geom_groups.value} />
      <GroupRow kind="site" groups={site_groups.value} />
    </>
  );
}

function GroupRow({ kind, groups }: { kind: "geom" | "site"; groups: boolean[] }) {
  return (
    <div class="row" role="group" aria-label={`Groups of ${kind}s`}>
      <span class="name">{kind === "geom" ? "Geoms" : "Sites"}</span>
      {groups.map((on, i) => (
        <button key={i} class="toggle" data-testid={`${kind}-group-${i}`} aria-pressed={on} aria-label={`${kind} group ${i}`} onClick={() => toggle_group(kind, i)}>{i}</button>
      ))}
    </div>
  );
}
