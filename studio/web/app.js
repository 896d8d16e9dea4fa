"use strict";
// The view's page. Protocol: docs/view_protocol.md. The server decides everything; the page shows the
// state it is told and sends wishes.

const $ = (id) => document.getElementById(id);
const stage = $("stage"), canvas = $("picture"), context = canvas.getContext("2d", { alpha: false });
const kSpeeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50];
const kReverseBeat = 0.1;  // seconds between two instants that are asked for backwards
const kClickTravel = 3;  // CSS pixels a hand may shake

let socket = null, client = 0, retries = 0, ended = false, cameras = [];
let state = null;      // newest state message
let picture = null;    // header of the picture on the screen
let drag = null;       // pull of a body: {u, v, point: null until the server has found one}
let noticeTimer = 0;
let logEnd = 0, seeking = false, reverseTimer = 0;  // of a log that is played [s]

// The token has become a cookie: out of the address bar, history and screenshots.
if (location.search) history.replaceState(null, "", location.pathname);

// ---- connection ----

function connect() {
  showLink("connecting", "Connecting");
  socket = new WebSocket(`ws://${location.host}/ws`);
  socket.binaryType = "arraybuffer";
  let greeted = false;
  socket.onmessage = (event) => {
    greeted = true;
    if (typeof event.data === "string") receive(JSON.parse(event.data));
    else pictures = pictures.then(() => showPicture(event.data)).catch(() => {});
  };
  socket.onclose = async (event) => {
    socket = null;
    endDrag();
    document.body.classList.add("offline");
    document.body.classList.remove("running");
    state = null;
    $("play-label").textContent = "Play";
    ended = ended || event.code === 1001;
    const slow = event.code === 1013;
    const why = ended ? "The simulation has ended. Start it again and open the address that it prints."
      : slow ? "This page could not keep up and was disconnected. Trying again…"
      : "The connection to the simulation is lost. Trying again…";
    showBanner(why);
    showLink("lost", ended ? "Ended" : "Not connected");
    showControls();
    if (!picture) $("placeholder-text").textContent = "Not connected";
    // Another simulation may listen at this address by now: its token is a new one.
    if (!ended && !greeted && await isTurnedAway()) {
      ended = true;
      showBanner("Another simulation runs at this address now. Open the address that it printed.");
    }
    if (!ended) setTimeout(connect, Math.min(5000, 400 * 2 ** retries++));
  };
}

async function isTurnedAway() {
  try {
    return (await fetch("/")).status === 401;
  } catch {
    return false;
  }
}

function send(message) {
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

function inControl() { return socket !== null && state !== null && state.controller === client; }

/** Sends what only the controller may; tells the others why nothing happens. */
function wish(message) {
  if (inControl()) send(message);
  else if (socket) tellWatching();
}

/** A wish whose result is known: the next key press builds on it before the server has answered. */
function wishFor(message, result) {
  wish(message);
  if (!inControl()) return;
  Object.assign(state, result);
  showState();
}

function tellWatching() { showNotice("You are watching. Press “Take control” first."); }

function receive(message) {
  switch (message.type) {
    case "hello":
      client = message.client;
      retries = 0;
      lastSequence = 0n;
      cameras = message.cameras;
      logEnd = message.log_end;
      $("timeline").hidden = logEnd === 0;
      $("seek").max = logEnd;
      $("end").textContent = `of ${logEnd.toFixed(2)} s`;
      $("camera").replaceChildren(...cameras.map((name) => new Option(name === "free" ? "Free camera" : name, name)));
      document.body.classList.remove("offline");
      if (!picture) $("placeholder-text").textContent = "Waiting for the first picture…";
      showLink("live", "Live");
      break;
    case "state":
      state = message;
      showState();
      break;
    case "picked":
      showPicked(message);
      break;
    case "pulled":
      if (drag && drag.point) drag.point = message.point;
      drawPull();
      break;
    case "notice":
      if (drag && !drag.point) endDrag();
      showNotice(message.text);
      break;
  }
}

// ---- pictures ----

const arrivals = [];     // [ms] when pictures were shown in the last second
let lastSequence = 0n, missed = 0;
let pictures = Promise.resolve();  // decoded one after the other: they must not overtake

async function showPicture(bytes) {
  const view = new DataView(bytes);
  if (bytes.byteLength < 152 || view.getUint32(0) !== 0x474c5631) return;
  const sequence = view.getBigUint64(8, true);
  if (lastSequence !== 0n && sequence > lastSequence) missed += Number(sequence - lastSequence) - 1;
  lastSequence = sequence;
  const header = {
    time: view.getFloat64(24, true), width: view.getUint16(32, true), height: view.getUint16(34, true),
    orthographic: (view.getUint32(40, true) & 1) !== 0,
    fx: view.getFloat32(44, true), fy: view.getFloat32(48, true), cx: view.getFloat32(52, true), cy: view.getFloat32(56, true),
    p: [60, 68, 76].map((at) => view.getFloat64(at, true)),
    q: [84, 92, 100, 108].map((at) => view.getFloat64(at, true)),
    lens: view.getUint32(116, true),
    d: [0, 1, 2, 3, 4, 5, 6, 7].map((i) => view.getFloat32(120 + 4 * i, true)),
  };
  try {
    const image = await createImageBitmap(new Blob([new Uint8Array(bytes, view.getUint32(4, true))], { type: "image/jpeg" }));
    if (canvas.width !== image.width || canvas.height !== image.height) {
      canvas.width = image.width;
      canvas.height = image.height;
    }
    context.drawImage(image, 0, 0);
    image.close();
  } finally {
    send({ type: "seen" });
  }
  picture = header;
  $("placeholder").hidden = true;
  arrivals.push(performance.now());
  drawPull();
}

/** Where the picture lies in the stage: object-fit leaves margins. */
function pictureBox() {
  const scale = Math.min(stage.clientWidth / canvas.width, stage.clientHeight / canvas.height);
  return {
    scale,
    left: (stage.clientWidth - scale * canvas.width) / 2,
    top: (stage.clientHeight - scale * canvas.height) / 2,
  };
}

function toPixel(event) {
  const box = pictureBox(), at = stage.getBoundingClientRect();
  return { u: (event.clientX - at.left - box.left) / box.scale, v: (event.clientY - at.top - box.top) / box.scale };
}

function inPicture({ u, v }) { return u >= 0 && v >= 0 && u < canvas.width && v < canvas.height; }

/** Place in the picture, in focal lengths, of the direction (x, y, z): right, down, ahead (docs/cameras.md); null when it is behind. */
function throughLens({ orthographic, lens, d }, x, y, z) {
  if (orthographic) return [x, y];
  if (lens === 4) return [Math.atan2(x, z), Math.atan2(y, Math.hypot(x, z))];
  if (lens === 3) {
    const across = Math.hypot(x, y), t = Math.atan2(across, z), t2 = t * t;
    const scale = across > 0 ? t * (1 + t2 * (d[0] + t2 * (d[1] + t2 * (d[2] + t2 * d[3])))) / across : 0;
    return [x * scale, y * scale];
  }
  if (z <= 0) return null;
  const a = x / z, b = y / z, r2 = a * a + b * b;
  if (lens === 0) return [a, b];
  const radial = (1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]))) / (1 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
  return [a * radial + 2 * d[2] * a * b + d[3] * (r2 + 2 * a * a), b * radial + d[2] * (r2 + 2 * b * b) + 2 * d[3] * a * b];
}

/** Pixel of a point in the world, or null when it lies behind the camera. */
function project(point) {
  const [w, x, y, z] = picture.q, d = point.map((value, i) => value - picture.p[i]);
  // Columns of the rotation matrix: the camera's axes in the world.
  const right = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)];
  const up = [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)];
  const back = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)];
  const dot = (axis) => axis[0] * d[0] + axis[1] * d[1] + axis[2] * d[2];
  const at = throughLens(picture, dot(right), -dot(up), -dot(back));
  return at && { u: picture.cx + picture.fx * at[0], v: picture.cy + picture.fy * at[1] };
}

function drawPull() {
  const from = drag && drag.point && picture ? project(drag.point) : null;
  $("overlay").classList.toggle("on", from !== null);
  if (!from) return;
  const box = pictureBox();
  const x1 = box.left + from.u * box.scale, y1 = box.top + from.v * box.scale;
  const x2 = box.left + drag.u * box.scale, y2 = box.top + drag.v * box.scale;
  for (const line of [$("pull"), $("pull-shadow")])
    for (const [name, value] of Object.entries({ x1, y1, x2, y2 })) line.setAttribute(name, value);
  $("pull-from").setAttribute("cx", x1);
  $("pull-from").setAttribute("cy", y1);
  $("pull-to").setAttribute("cx", x2);
  $("pull-to").setAttribute("cy", y2);
}

// ---- what the user reads ----

function showState() {
  document.body.classList.toggle("running", !state.paused);
  $("play-label").textContent = state.paused ? "Play" : "Pause";
  $("play").title = state.paused ? "Play (Space)" : "Pause (Space)";
  $("speed").textContent = `${state.speed}×`;
  $("camera").value = state.camera;
  $("time").textContent = `${state.time.toFixed(3)} s`;
  $("steps").textContent = state.step.toLocaleString("en");
  $("factor").textContent = state.error ? "–" : state.paused ? "paused" : `${state.realtime_factor.toFixed(2)}×`;
  $("dropped").textContent = (state.dropped + missed).toLocaleString("en");
  $("warnings").textContent = state.warnings;
  $("warnings-cell").hidden = state.warnings === 0;
  $("hash").textContent = state.hash;
  if (!seeking) $("seek").value = state.time;
  const now = performance.now();
  while (arrivals.length && arrivals[0] < now - 1000) arrivals.shift();
  $("rate").textContent = `${arrivals.length} /s`;
  showBanner(state.error ? `The simulation has a problem: ${state.error}` : "");
  showControls();
}

function showControls() {
  const mine = inControl();
  for (const id of ["play", "step", "reset", "slower", "faster", "camera", "seek", "reverse"]) $(id).disabled = !mine;
  $("role").hidden = $("claim").hidden = mine || !socket || !state;
  $("role").textContent = state && state.controller === 0 ? "Nobody is in control" : "Watching: another window is in control";
  if (!mine) endDrag();
}

function showLink(kind, text) {
  $("link").dataset.state = kind;
  $("link-text").textContent = kind === "live" && state && state.clients > 1 ? `${text}, ${state.clients} windows` : text;
}

function showBanner(text) {
  if ($("banner").textContent !== text) $("banner").textContent = text;
  $("banner").hidden = text === "";
}

function showNotice(text) {
  $("notice").textContent = text;
  $("notice").hidden = false;
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(() => { $("notice").hidden = true; }, 4000);
}

function showPicked(message) {
  if (message.dragging) {
    if (drag) drag.point = message.point;
    drawPull();
    showNotice(`Pulling ${message.body || "a body without a name"}`);
    return;
  }
  $("selected").textContent = message.body || "a body without a name";
  $("selected").hidden = !message.found;
}

// ---- the time of a log ----

function seekTo(time) {
  wish({ type: "seek", time: Math.max(0, Math.min(logEnd, time)) });
}

function playBackwards(on) {
  clearInterval(reverseTimer);
  $("reverse").setAttribute("aria-pressed", on);
  if (!on || !state) return;
  if (!state.paused) wish({ type: "pause" });
  let time = state.time;
  reverseTimer = setInterval(() => {
    time -= kReverseBeat * state.speed;
    seekTo(time);
    if (time <= 0 || !inControl()) playBackwards(false);
  }, 1000 * kReverseBeat);
}

$("seek").addEventListener("input", () => {
  seeking = true;
  playBackwards(false);
  seekTo(Number($("seek").value));
});
$("seek").addEventListener("change", () => { seeking = false; });
$("reverse").addEventListener("click", () => playBackwards($("reverse").getAttribute("aria-pressed") !== "true"));

// ---- wishes ----

function changeSpeed(by) {
  if (!state) return;
  const near = kSpeeds.reduce((best, value, i) => Math.abs(Math.log(value / state.speed)) < Math.abs(Math.log(kSpeeds[best] / state.speed)) ? i : best, 0);
  const speed = kSpeeds[Math.max(0, Math.min(kSpeeds.length - 1, near + by))];
  wishFor({ type: "speed", value: speed }, { speed });
}

function changeCamera(by) {
  if (!state || cameras.length === 0) return;
  const at = Math.max(0, cameras.indexOf(state.camera));
  const camera = cameras[(at + by + cameras.length) % cameras.length];
  wishFor({ type: "camera", name: camera }, { camera });
}

const actions = {
  play: () => {
    playBackwards(false);
    if (state) wishFor({ type: state.paused ? "resume" : "pause" }, { paused: !state.paused });
  },
  step: (event) => wish({ type: "step", count: event.shiftKey ? 10 : 1 }),
  reset: () => wish({ type: "reset" }),
  slower: () => changeSpeed(-1),
  faster: () => changeSpeed(1),
  claim: () => send({ type: "claim" }),
  "help-button": () => $("help").showModal(),
};
for (const [id, action] of Object.entries(actions)) {
  $(id).addEventListener("click", (event) => {
    action(event);
    // After a click with the mouse the Space key plays and pauses again.
    if (event.detail > 0 && !$("help").open) stage.focus({ preventScroll: true });
  });
}
$("camera").addEventListener("change", () => {
  wish({ type: "camera", name: $("camera").value });
  stage.focus();
});

const keys = {
  " ": actions.play,
  ArrowRight: actions.step,
  Backspace: actions.reset,
  "-": actions.slower,
  "=": actions.faster,
  "+": actions.faster,
  "[": () => changeCamera(-1),
  "]": () => changeCamera(1),
  Escape: () => wish({ type: "camera", name: "free" }),
  "?": actions["help-button"],
};
document.addEventListener("keydown", (event) => {
  if ($("help").open || event.ctrlKey || event.altKey || event.metaKey) return;
  // A focused button keeps its own keys, and so does the list of cameras.
  const inside = event.target.tagName;
  if ((inside === "BUTTON" && event.key === " ") || (inside === "SELECT" && event.key !== "Escape")) return;
  const action = keys[event.key];
  if (!action) return;
  event.preventDefault();
  if (!event.repeat || event.key === "ArrowRight") action(event);
});

// ---- mouse ----

let gesture = null;  // {kind: orbit | pan | pull, x, y}
// Moves are gathered and sent once per screen refresh: the server needs no more.
let travel = { dx: 0, dy: 0 }, travelKind = "", zoom = 0, pullMoved = false, flushQueued = false;

function queueFlush() {
  if (flushQueued) return;
  flushQueued = true;
  requestAnimationFrame(flush);
}

function flush() {
  flushQueued = false;
  if (travelKind && (travel.dx || travel.dy)) send({ type: travelKind, dx: travel.dx, dy: travel.dy });
  if (zoom) send({ type: "zoom", amount: Math.max(-10, Math.min(10, zoom)) });
  if (pullMoved && drag) send({ type: "drag_move", u: drag.u, v: drag.v });
  travel = { dx: 0, dy: 0 };
  zoom = 0;
  pullMoved = false;
}

/** True when the free camera may be moved; says why not. */
function mayMoveCamera() {
  if (!inControl()) {
    tellWatching();
    return false;
  }
  if (state.camera === "free") return true;
  showNotice("This camera belongs to the model. Press Esc for the free camera.");
  return false;
}

stage.addEventListener("pointerdown", (event) => {
  stage.focus({ preventScroll: true });
  if (gesture || !picture || event.button === 1) return;
  event.preventDefault();
  const kind = event.ctrlKey ? "pull" : event.button === 2 ? "pan" : "orbit";
  if (kind === "pull" && !inPicture(toPixel(event))) return;
  if (kind === "pull" && !inControl()) return tellWatching();
  gesture = { kind, x: event.clientX, y: event.clientY, moved: false, id: event.pointerId };
  stage.setPointerCapture(event.pointerId);
  if (kind !== "pull") return;
  drag = { ...toPixel(event), point: null };
  stage.classList.add("pull");
  send({ type: "drag_start", u: drag.u, v: drag.v });
});

stage.addEventListener("pointermove", (event) => {
  if (!gesture || event.pointerId !== gesture.id) return;
  if (gesture.kind === "pull") {
    if (!drag) return;
    Object.assign(drag, toPixel(event));
    pullMoved = true;
    drawPull();
    return queueFlush();
  }
  const dx = event.clientX - gesture.x, dy = event.clientY - gesture.y;
  if (!gesture.moved) {
    if (Math.hypot(dx, dy) < kClickTravel) return;
    if (!mayMoveCamera()) {
      gesture = null;
      return;
    }
    gesture.moved = true;
    stage.classList.add("moving");
  }
  if (travelKind !== gesture.kind) flush();
  const height = pictureBox().scale * canvas.height;
  travelKind = gesture.kind;
  travel.dx += dx / height;
  travel.dy += dy / height;
  gesture.x = event.clientX;
  gesture.y = event.clientY;
  queueFlush();
});

function endGesture() {
  gesture = null;
  flush();
  stage.classList.remove("moving");
  endDrag();
}

function endDrag() {
  if (!drag) return;
  drag = null;
  send({ type: "drag_end" });
  stage.classList.remove("pull");
  $("notice").hidden = true;
  drawPull();
}

for (const name of ["pointerup", "pointercancel", "lostpointercapture"])
  stage.addEventListener(name, (event) => { if (gesture && event.pointerId === gesture.id) endGesture(); });
stage.addEventListener("contextmenu", (event) => event.preventDefault());
stage.addEventListener("dblclick", (event) => {
  const at = toPixel(event);
  if (picture && inPicture(at)) wish({ type: "pick", ...at });
});
stage.addEventListener("wheel", (event) => {
  event.preventDefault();
  if (!picture || !mayMoveCamera()) return;
  // A notch is about 100 px, 3 lines or 1 page.
  const notches = event.deltaY / [100, 3, 1][event.deltaMode];
  zoom -= 0.15 * notches;
  queueFlush();
}, { passive: false });
new ResizeObserver(drawPull).observe(stage);

showControls();
connect();
