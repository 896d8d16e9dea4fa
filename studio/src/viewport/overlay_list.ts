import { live_field, model_field } from "../fields";
import { model, name_of } from "../state";
import { kContactSize } from "../panels/contacts";
import type { Vector } from "../protocol";
import { kGeomFields } from "./geoms";
import type { Labels } from "./labels";
import { frame_of, to_world, type Colour, type Frame, type Lines } from "./lines";
import { outline } from "./outlines";

// How each overlay of overlays.ts is drawn: the fields that it watches, and its lines.

export interface Drawing { lines: Lines; labels: Labels; selected: number; geom_groups: boolean[]; site_groups: boolean[] }

const kOrange: Colour = [0.95, 0.7, 0.3], kBlue: Colour = [0.45, 0.7, 1], kPink: Colour = [1, 0.5, 0.75], kGreen: Colour = [0.5, 0.9, 0.6];
const kWorld: Frame = { p: [0, 0, 0], R: [1, 0, 0, 0, 1, 0, 0, 0, 1] };

interface Drawn { watches: readonly string[]; draw: (drawing: Drawing) => void }

const live = (name: string) => live_field(name).value;
const constant = (name: string) => model_field(name).value;
const kMetresPerNewton = 0.005;  // MuJoCo's visual/map/force
/** Length of frames and arrows [m]: a tenth of MuJoCo's mean size of bodies, but that of a robot in a building. */
const unit = () => Math.min(0.05, Math.max(0.005, 0.1 * (constant("stat.meansize")[0] || 1)));

function each(count: number, use: (i: number) => void) {
  for (let i = 0; i < count; ++i) use(i);
}

function vector(values: Float32Array, i: number): Vector {
  return [values[3 * i], values[3 * i + 1], values[3 * i + 2]];
}

function axes_of(positions: string, rotations: string, shown: (i: number) => boolean = () => true): Drawn["draw"] {
  return ({ lines }) => {
    const p = live(positions), R = live(rotations);
    each(R.length / 9, (i) => { if (shown(i)) lines.axes(frame_of(p, R, i), 1.5 * unit()); });
  };
}

function draw_contacts({ lines }: Drawing, forces: boolean) {
  const all = live("contact"), scale = kMetresPerNewton;
  each(all.length / kContactSize, (i) => {
    const c = all.subarray(kContactSize * i, kContactSize * (i + 1));
    const point: Vector = [c[2], c[3], c[4]], n: Vector = [c[5], c[6], c[7]];
    const tangent: Vector = Math.abs(n[2]) < 0.9 ? [n[1], -n[0], 0] : [0, n[2], -n[1]], size = Math.hypot(...tangent);
    const t = tangent.map((value) => value / size), s = [n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]];
    const frame = { p: point, R: [t[0], s[0], n[0], t[1], s[1], n[1], t[2], s[2], n[2]] };
    if (!forces) return lines.circle(frame, 0.4 * unit(), kOrange);
    lines.arrow(point, [point[0] + scale * c[8], point[1] + scale * c[9], point[2] + scale * c[10]], kOrange);
  });
}

function draw_joints({ lines }: Drawing) {
  const anchors = live("xanchor"), axes = live("xaxis"), types = constant("jnt_type");
  each(types.length, (i) => {
    const p = vector(anchors, i), a = vector(axes, i), length = unit();
    if (types[i] < 2) return lines.box({ ...kWorld, p }, [0.3 * length, 0.3 * length, 0.3 * length], kBlue);
    lines.arrow([p[0] - length * a[0], p[1] - length * a[1], p[2] - length * a[2]], [p[0] + length * a[0], p[1] + length * a[1], p[2] + length * a[2]], kBlue);
  });
}

function draw_inertia({ lines }: Drawing) {
  const p = live("xipos"), R = live("ximat"), masses = constant("body_mass"), inertia = constant("body_inertia");
  each(masses.length, (i) => {
    if (masses[i] < 1e-9) return;
    const [x, y, z] = vector(inertia, i), half = (sum: number) => Math.sqrt(Math.max(0, 1.5 * sum / masses[i]));
    lines.box(frame_of(p, R, i), [half(y + z - x), half(x + z - y), half(x + y - z)], kPink);
  });
}

function draw_tendons({ lines }: Drawing) {
  const first = live("ten_wrapadr"), count = live("ten_wrapnum"), points = live("wrap_xpos");
  each(first.length, (i) => each(Math.max(0, count[i] - 1), (k) => lines.segment(vector(points, first[i] + k), vector(points, first[i] + k + 1), kGreen)));
}

function draw_sites({ lines, site_groups }: Drawing) {
  const p = live("site_xpos"), R = live("site_xmat"), types = constant("site_type"), sizes = constant("site_size"), groups = constant("site_group");
  each(types.length, (i) => { if (site_groups[groups[i]]) outline(lines, types[i], sizes.subarray(3 * i, 3 * i + 3), frame_of(p, R, i), kGreen); });
}

function draw_collision({ lines, geom_groups }: Drawing) {
  const p = live("geom_xpos"), R = live("geom_xmat"), types = constant("geom_type"), sizes = constant("geom_size"), groups = constant("geom_group");
  const mask = constant("geom_contype"), affinity = constant("geom_conaffinity"), boxes = constant("geom_aabb");
  each(types.length, (i) => {
    if ((!mask[i] && !affinity[i]) || !geom_groups[groups[i]]) return;
    outline(lines, types[i], sizes.subarray(3 * i, 3 * i + 3), frame_of(p, R, i), kBlue, boxes.subarray(6 * i, 6 * i + 6));
  });
}

function draw_com({ lines }: Drawing) {
  const p = live("subtree_com"), roots = constant("body_parentid");
  each(roots.length, (i) => { if (i > 0 && roots[i] === 0) lines.box({ ...kWorld, p: vector(p, i) }, [0.3 * unit(), 0.3 * unit(), 0.3 * unit()], kOrange); });
}

function draw_actuators({ lines }: Drawing) {
  const kJoint = 0, kJointInParent = 1;  // mjtTrn
  const kinds = constant("actuator_trntype"), ids = constant("actuator_trnid"), forces = live("actuated"), anchors = live("xanchor"), axes = live("xaxis");
  const most = forces.reduce((largest, force) => Math.max(largest, Math.abs(force)), 1e-9);
  each(kinds.length, (i) => {
    if (kinds[i] !== kJoint && kinds[i] !== kJointInParent) return;
    const joint = ids[2 * i], p = vector(anchors, joint), a = vector(axes, joint), length = 2 * unit() * forces[i] / most;
    lines.box({ ...kWorld, p }, [0.2 * unit(), 0.2 * unit(), 0.2 * unit()], kGreen);
    lines.arrow(p, [p[0] + length * a[0], p[1] + length * a[1], p[2] + length * a[2]], forces[i] < 0 ? kPink : kGreen);
  });
}

function draw_cameras({ lines }: Drawing) {
  const p = live("cam_xpos"), R = live("cam_xmat"), fovy = constant("cam_fovy");
  each(fovy.length, (i) => {
    const frame = frame_of(p, R, i), depth = 2 * unit(), y = depth * Math.tan(fovy[i] * Math.PI / 360), x = 4 / 3 * y;
    const corners = [[-x, -y], [x, -y], [x, y], [-x, y]].map(([u, v]) => to_world(frame, u, v, -depth));
    corners.forEach((corner, k) => {
      lines.segment(frame.p, corner, kBlue);
      lines.segment(corner, corners[(k + 1) % 4], kBlue);
    });
  });
}

function draw_lights({ lines }: Drawing) {
  const p = live("light_xpos"), d = live("light_xdir");
  each(p.length / 3, (i) => {
    const from = vector(p, i), along = vector(d, i), length = 2 * unit();
    lines.arrow(from, [from[0] + length * along[0], from[1] + length * along[1], from[2] + length * along[2]], kOrange);
  });
}

function draw_labels({ labels }: Drawing) {
  const p = live("xipos"), names = model.value?.bodies;
  each(p.length / 3, (i) => { if (i > 0) labels.text(vector(p, i), name_of(names, i, "body")); });
}

function draw_selection({ lines, selected }: Drawing) {
  if (selected < 0) return;
  const p = live("geom_xpos"), R = live("geom_xmat"), bodies = constant("geom_bodyid"), boxes = constant("geom_aabb");
  each(bodies.length, (i) => {
    if (bodies[i] !== selected || boxes.length < 6 * i + 6) return;
    const box = boxes.subarray(6 * i, 6 * i + 6), frame = frame_of(p, R, i);
    lines.box({ ...frame, p: to_world(frame, box[0], box[1], box[2]) }, [box[3], box[4], box[5]], kOrange);
  });
  lines.axes(frame_of(live("xpos"), live("xmat"), selected), 2 * unit());
}

const kDrawn: Record<string, Drawn> = {
  contact_points: { watches: ["contact"], draw: (drawing) => draw_contacts(drawing, false) },
  contact_forces: { watches: ["contact"], draw: (drawing) => draw_contacts(drawing, true) },
  joints: { watches: ["xanchor", "xaxis"], draw: draw_joints },
  com: { watches: ["subtree_com"], draw: draw_com },
  inertia: { watches: ["xipos", "ximat"], draw: draw_inertia },
  tendons: { watches: ["ten_wrapadr", "ten_wrapnum", "wrap_xpos"], draw: draw_tendons },
  actuators: { watches: ["actuated", "xanchor", "xaxis"], draw: draw_actuators },
  cameras: { watches: ["cam_xpos", "cam_xmat"], draw: draw_cameras },
  lights: { watches: ["light_xpos", "light_xdir"], draw: draw_lights },
  sites: { watches: ["site_xpos", "site_xmat"], draw: draw_sites },
  collision: { watches: kGeomFields, draw: draw_collision },
  frames_world: { watches: [], draw: ({ lines }) => lines.axes(kWorld, 1) },
  frames_body: { watches: ["xpos", "xmat"], draw: axes_of("xpos", "xmat") },
  frames_geom: { watches: kGeomFields, draw: axes_of("geom_xpos", "geom_xmat") },
  frames_site: { watches: ["site_xpos", "site_xmat"], draw: axes_of("site_xpos", "site_xmat") },
  labels: { watches: ["xipos"], draw: draw_labels },
  selection: { watches: [...kGeomFields, "xpos", "xmat"], draw: draw_selection },
};

export function fields_of_overlays(overlays: readonly string[], whole_scene: boolean): string[] {
  const names = overlays.flatMap((id) => kDrawn[id]?.watches ?? []);
  return [...new Set(whole_scene ? [...names, ...kGeomFields] : names)];
}

export function draw_overlays(overlays: readonly string[], drawing: Drawing) {
  for (const id of overlays) kDrawn[id]?.draw(drawing);
}
