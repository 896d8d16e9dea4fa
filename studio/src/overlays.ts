import type { Action } from "./actions";
import { geom_groups, overlays_on, site_groups, toggle_in } from "./settings";

// The overlays that the viewport can draw over the image, with the keys of MuJoCo's `simulate`.

export interface Overlay { id: string; label: string; key?: string; tip: string }

export const kOverlays: readonly Overlay[] = [
  { id: "contact_points", label: "Contact points", key: "c", tip: "Contacts as discs in the contact plane" },
  { id: "contact_forces", label: "Contact forces", key: "f", tip: "Forces on the second geom of each contact, 5 mm per newton" },
  { id: "joints", label: "Joints", key: "j", tip: "Axes of hinges and slides, centres of balls and free joints" },
  { id: "com", label: "Centre of mass", key: "m", tip: "Centre of mass of each tree of bodies" },
  { id: "inertia", label: "Inertia", key: "i", tip: "Boxes with the same inertia as the bodies" },
  { id: "tendons", label: "Tendons", key: "v", tip: "Paths of spatial tendons" },
  { id: "actuators", label: "Actuators", key: "u", tip: "Joints and sites that actuators act on, coloured by force" },
  { id: "cameras", label: "Cameras", key: "q", tip: "Frusta of the model's cameras" },
  { id: "lights", label: "Lights", key: "z", tip: "Positions and directions of lights" },
  { id: "sites", label: "Sites", tip: "Sites of the enabled groups" },
  { id: "collision", label: "Collision shapes", key: "h", tip: "Wireframes of the geoms that can collide" },
  { id: "frames_world", label: "World frame", tip: "Axes of the world: x red, y green, z blue" },
  { id: "frames_body", label: "Body frames", tip: "Axes of each body: x red, y green, z blue" },
  { id: "frames_geom", label: "Geom frames", tip: "Axes of each geom: x red, y green, z blue" },
  { id: "frames_site", label: "Site frames", tip: "Axes of each site: x red, y green, z blue" },
  { id: "labels", label: "Body names", key: "F7", tip: "Names of bodies at their centres of mass" },
  { id: "selection", label: "Selected body", key: "o", tip: "A box and a frame at the selected body" },
];

const kFrames = ["frames_world", "frames_body", "frames_geom", "frames_site"];

export function toggle_overlay(id: string) {
  overlays_on.value = toggle_in(overlays_on.value, id);
}

export function toggle_group(kind: "geom" | "site", group: number) {
  const groups = kind === "geom" ? geom_groups : site_groups;
  groups.value = groups.value.map((on, i) => i === group ? !on : on);
}

/** Shows the next kind of frames and hides the others, as F6 does in `simulate`. */
function cycle_frames() {
  const at = kFrames.findIndex((id) => overlays_on.value.includes(id));
  const others = overlays_on.value.filter((id) => !kFrames.includes(id));
  overlays_on.value = at + 1 < kFrames.length ? [...others, kFrames[at + 1]] : others;
}

export const overlay_actions: Action[] = [
  ...kOverlays.filter(({ key }) => key).map(({ id, label, key }): Action => ({
    id: `overlay-${id}`, label, group: "Overlays", keys: [key!], run: () => toggle_overlay(id),
  })),
  { id: "overlay-frames", label: "Next kind of frames", group: "Overlays", keys: ["F6"], run: cycle_frames },
  ...[0, 1, 2, 3, 4, 5].map((i): Action => ({
    id: `geom-group-${i}`, label: `Geom group ${i}`, group: "Groups", keys: [`${i}`], run: () => toggle_group("geom", i),
  })),
  ...[0, 1, 2, 3, 4, 5].map((i): Action => ({
    id: `site-group-${i}`, label: `Site group ${i}`, group: "Groups", keys: [`Shift+${i}`], run: () => toggle_group("site", i),
  })),
];
