"use strict";
// Two panes that show images with zoom and a cross; a point set in both makes a pair. Pixels: x right, y down, the corner of
// the top left pixel is (0, 0), in pixels of the original photograph. Points of the scene come from the depth of the view.

const state = JSON.parse(document.getElementById("state").textContent);
const byId = (id) => document.getElementById(id);
const pairs = state.pairs.map((pair) => ({ ...pair }));
let saved = true;
let view = 0;

class Pane {
  constructor(name, width, height) {
    this.canvas = byId(name);
    this.at = byId(name + "-at");
    this.image = null;
    this.open = null; // the point that waits for its partner: {pixel, point}
    this.resize(width, height);
    const canvas = this.canvas;
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    canvas.addEventListener("pointercancel", () => (this.drag = null));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.fit(false)).observe(canvas);
  }

  resize(width, height) {
    this.width = width;
    this.height = height;
    this.cross = [width / 2, height / 2];
    this.zoom = 0; // 0: not fitted yet
  }

  /** Shows the whole image, or keeps the place and draws again. */
  fit(all) {
    const box = this.canvas.getBoundingClientRect();
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.max(1, Math.round(box.width * ratio));
    this.canvas.height = Math.max(1, Math.round(box.height * ratio));
    if (all || !this.zoom) {
      this.zoom = Math.min(box.width / this.width, box.height / this.height) || 1;
      this.left = (box.width - this.width * this.zoom) / 2;
      this.top = (box.height - this.height * this.zoom) / 2;
    }
    this.draw();
  }

  toImage(event) {
    const box = this.canvas.getBoundingClientRect();
    return [(event.clientX - box.left - this.left) / this.zoom, (event.clientY - box.top - this.top) / this.zoom];
  }

  zoomAt(factor, x, y) {
    const zoom = Math.min(64, Math.max(0.02, this.zoom * factor));
    this.left = x - ((x - this.left) * zoom) / this.zoom;
    this.top = y - ((y - this.top) * zoom) / this.zoom;
    this.zoom = zoom;
    this.draw();
  }

  press(event) {
    if (event.button !== 0) return;
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    this.drag = { x: event.clientX, y: event.clientY, left: this.left, top: this.top, moved: false };
    event.preventDefault();
  }

  move(event) {
    if (!this.drag) {
      this.cross = this.toImage(event);
      this.draw();
      return;
    }
    const dx = event.clientX - this.drag.x;
    const dy = event.clientY - this.drag.y;
    if (Math.hypot(dx, dy) > 4) this.drag.moved = true;
    if (!this.drag.moved) return;
    this.left = this.drag.left + dx;
    this.top = this.drag.top + dy;
    this.draw();
  }

  release(event) {
    const drag = this.drag;
    this.drag = null;
    if (!drag || drag.moved) return;
    this.cross = this.toImage(event);
    set(this);
  }

  wheel(event) {
    event.preventDefault();
    const box = this.canvas.getBoundingClientRect();
    this.zoomAt(Math.exp(-event.deltaY / 400), event.clientX - box.left, event.clientY - box.top);
  }

  key(event) {
    const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const step = event.altKey ? 0.1 : event.shiftKey ? 20 : 1;
    if (moves[event.key]) {
      this.cross = this.cross.map((value, i) => value + step * moves[event.key][i]);
      this.keepInView();
    } else if (event.key === "Enter" || event.key === " ") set(this);
    else if (event.key === "+" || event.key === "=" || event.key === "-") {
      const factor = event.key === "-" ? 1 / 1.5 : 1.5;
      this.zoomAt(factor, this.left + this.cross[0] * this.zoom, this.top + this.cross[1] * this.zoom);
      this.keepInView();
    } else if (event.key === "0") this.fit(true);
    else if (event.key === "Escape") discard();
    else return;
    event.preventDefault();
  }

  keepInView() {
    const box = this.canvas.getBoundingClientRect();
    const x = this.left + this.cross[0] * this.zoom;
    const y = this.top + this.cross[1] * this.zoom;
    this.left += Math.min(0, box.width - 20 - x) + Math.max(0, 20 - x);
    this.top += Math.min(0, box.height - 20 - y) + Math.max(0, 20 - y);
    this.draw();
  }

  inside([x, y]) {
    return x >= 0 && y >= 0 && x <= this.width && y <= this.height;
  }

  draw() {
    const ratio = window.devicePixelRatio || 1;
    const context = this.canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    if (this.image) {
      context.imageSmoothingEnabled = this.zoom < 2;
      context.drawImage(this.image, this.left, this.top, this.width * this.zoom, this.height * this.zoom);
    }
    this.marks().forEach(({ at, label, open }) => this.mark(context, at, label, open));
    this.drawCross(context);
    this.at.textContent = this.inside(this.cross) ? this.cross.map((v) => v.toFixed(1)).join(", ") + " px" : "";
  }

  drawCross(context) {
    const [x, y] = [this.left + this.cross[0] * this.zoom, this.top + this.cross[1] * this.zoom];
    for (const [width, colour] of [[3, "#000a"], [1, "#ffe14d"]]) {
      context.lineWidth = width;
      context.strokeStyle = colour;
      context.beginPath();
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.moveTo(x + 3 * dx, y + 3 * dy);
        context.lineTo(x + 14 * dx, y + 14 * dy);
      }
      context.stroke();
    }
  }

  mark(context, at, label, open) {
    const [x, y] = [this.left + at[0] * this.zoom, this.top + at[1] * this.zoom];
    for (const [width, colour] of [[4, "#000a"], [2, open ? "#ff9d2e" : "#4ade5c"]]) {
      context.lineWidth = width;
      context.strokeStyle = colour;
      context.beginPath();
      context.arc(x, y, 6, 0, 2 * Math.PI);
      context.stroke();
    }
    context.font = "600 13px system-ui, sans-serif";
    context.lineWidth = 3;
    context.strokeStyle = "#000";
    context.strokeText(label, x + 9, y - 7);
    context.fillStyle = open ? "#ffb866" : "#7dff8d";
    context.fillText(label, x + 9, y - 7);
  }

  marks() {
    const made = pairs.map((pair, i) => ({ at: this.place(pair), label: String(i + 1) }));
    if (this.open) made.push({ at: this.place(this.open), label: String(pairs.length + 1), open: true });
    return made.filter(({ at }) => at);
  }
}

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
  scene.fit(true);
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
  photo.fit(true);
  show(0);
  tell("Click a point in the photograph and the same point in the scene.");
}

start().catch((error) => tell(`The page cannot start: ${error.message}`));
