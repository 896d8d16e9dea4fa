"use strict";
// Two panes (pick_pane.js); a point set in both makes a pair. Pixels: x right, y down, the corner of the top left pixel is
// (0, 0), in pixels of the original photograph. Points of the scene come from the depth of the view.

const state = JSON.parse(document.getElementById("state").textContent);
const byId = (id) => document.getElementById(id);
const pairs = state.pairs.map((pair) => ({ ...pair }));
let saved = true;
let view = 0;

class PhotoPane extends Pane {
  place(item) {
    return item.pixel;
  }

  pick(at) {
    return { pixel: at.map((v) => Math.round(100 * v) / 100) };
  }
}

class ScenePane extends Pane {
  /** Where the view shows a point; null behind it. */
  place(item) {
    const { p, R, f, centre } = state.views[view];
    const d = item.point.map((v, i) => v - p[i]);
    const seen = [0, 1, 2].map((j) => R[0][j] * d[0] + R[1][j] * d[1] + R[2][j] * d[2]);
    return seen[2] > 1e-6 ? [centre[0] + (f[0] * seen[0]) / seen[2], centre[1] + (f[1] * seen[1]) / seen[2]] : null;
  }

  pick(at) {
    const { p, R, f, centre } = state.views[view];
    const depth = depthAt(state.views[view], at);
    if (!depth) return null;
    const ray = [(at[0] - centre[0]) / f[0], (at[1] - centre[1]) / f[1], 1].map((v) => v * depth);
    return { point: [0, 1, 2].map((i) => Math.round(1e5 * (p[i] + R[i][0] * ray[0] + R[i][1] * ray[1] + R[i][2] * ray[2])) / 1e5) };
  }
}

/** Depth [m] at a place between pixel centres: on a plane 1 / depth is linear in the image. At edges, the pixel's own. */
function depthAt(shown, [x, y]) {
  const clamp = (v, size) => Math.min(size - 1, Math.max(0, v));
  const read = (i, j) => shown.values[clamp(j, shown.height) * shown.width + clamp(i, shown.width)];
  const own = read(Math.floor(x), Math.floor(y));
  const [i, j] = [Math.floor(x - 0.5), Math.floor(y - 0.5)];
  const [a, b] = [x - 0.5 - i, y - 0.5 - j];
  const four = [read(i, j), read(i + 1, j), read(i, j + 1), read(i + 1, j + 1)];
  if (!own || four.some((d) => !d)) return own;
  const [p, q, r, s] = four.map((d) => 1 / d);
  if (Math.abs(p - q - r + s) > 0.002 / own || Math.max(p, q, r, s) > 1.1 * Math.min(p, q, r, s)) return own;
  return 1 / ((1 - b) * ((1 - a) * p + a * q) + b * ((1 - a) * r + a * s));
}

const photo = new PhotoPane("photo", state.photo.width, state.photo.height);
const scene = new ScenePane("scene", 1, 1);

function tell(text) {
  byId("message").textContent = text;
}

/** Sets the open point of a pane at its cross, and makes a pair if the other pane has one. */
function set(pane) {
  const picked = pane.inside(pane.cross) ? pane.pick(pane.cross) : null;
  if (!picked) return tell(pane === scene && pane.inside(pane.cross) ? "Nothing is there in the scene." : "That is outside the image.");
  pane.open = picked;
  if (photo.open && scene.open) {
    pairs.push({ name: `pair ${pairs.length + 1}`, pixel: photo.open.pixel, point: scene.open.point });
    photo.open = scene.open = null;
    changed(`Pair ${pairs.length} added.`);
  } else {
    tell(`Now the same point in the ${pane === photo ? "scene" : "photograph"}.`);
    photo.draw();
    scene.draw();
  }
}

function discard() {
  photo.open = scene.open = null;
  tell("");
  photo.draw();
  scene.draw();
}

function changed(text) {
  saved = false;
  tell(text);
  list();
  photo.draw();
  scene.draw();
}

function list() {
  const rows = pairs.map((pair, i) => {
    const row = document.createElement("tr");
    const cell = (content, kind) => {
      const made = document.createElement("td");
      made.className = kind || "";
      made.append(content);
      row.append(made);
    };
    const name = document.createElement("input");
    name.type = "text";
    name.maxLength = 200;
    name.value = pair.name;
    name.setAttribute("aria-label", `Name of pair ${i + 1}`);
    name.addEventListener("input", () => {
      pair.name = name.value;
      saved = false;
    });
    const remove = document.createElement("button");
    remove.textContent = "Delete";
    remove.setAttribute("aria-label", `Delete pair ${i + 1}`);
    remove.addEventListener("click", () => {
      pairs.splice(i, 1);
      changed(`Pair ${i + 1} deleted.`);
      (byId("pairs").querySelectorAll("button")[Math.min(i, pairs.length - 1)] || byId("save")).focus();
    });
    cell(String(i + 1), "n");
    cell(name);
    cell(pair.pixel.map((v) => v.toFixed(1)).join(", "), "n");
    cell((pair.element ? `${pair.kind} ${pair.element} ` : "") + pair.point.map((v) => v.toFixed(3)).join(", "), "n");
    cell(remove);
    return row;
  });
  byId("pairs").replaceChildren(...rows);
  byId("count").textContent = `${pairs.length} pair${pairs.length === 1 ? "" : "s"}` + (pairs.length < 5 ? `, at least 5 are needed` : "");
}

/** A TOML basic string. */
function quoted(text) {
  return JSON.stringify(text).replace(/[\u007f-\u009f]/g, (c) => "\\u" + c.charCodeAt(0).toString(16).padStart(4, "0"));
}

function toToml() {
  const head = "# Pairs for gloam match: pixel x right, y down from the corner of the top left pixel; point in the world [m].\n";
  return head + pairs.map((pair) => {
    const corner = pair.corner && pair.corner !== "000" ? `\ncorner = ${quoted(pair.corner)}` : "";
    const where = pair.element ? `${pair.kind} = ${quoted(pair.element)}${corner}` : `point = [${pair.point.join(", ")}]`;
    return `\n[[pair]]\nname = ${quoted(pair.name)}\npixel = [${pair.pixel.join(", ")}]\n${where}\n`;
  }).join("");
}

function save() {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([toToml()], { type: "text/plain" }));
  link.download = "pairs.toml";
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  saved = true;
  tell(`${pairs.length} pairs saved as pairs.toml.`);
}

async function depths(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Float32Array(await new Response(stream).arrayBuffer());
}

function loaded(image, source) {
  return new Promise((resolve) => {
    image.onload = resolve;
    image.src = source;
  });
}

function show(index) {
  view = index;
  const shown = state.views[index];
  scene.resize(shown.width, shown.height);
  scene.image = shown.picture;
  scene.open = null;
  scene.showAll();
}

async function start() {
  for (const one of state.views) {
    one.values = await depths(one.depth);
    one.picture = new Image();
    await loaded(one.picture, one.image);
    byId("view").append(new Option(one.name));
  }
  photo.image = byId("photo-image");
  if (!photo.image.complete) await loaded(photo.image, photo.image.src);
  byId("view").addEventListener("change", (event) => show(event.target.selectedIndex));
  byId("save").addEventListener("click", save);
  byId("undo").addEventListener("click", discard);
  window.addEventListener("beforeunload", (event) => saved || event.preventDefault());
  list();
  photo.showAll();
  show(0);
  tell("Click a point in the photograph and the same point in the scene.");
}

start().catch((error) => tell(`The page cannot start: ${error.message}`));
