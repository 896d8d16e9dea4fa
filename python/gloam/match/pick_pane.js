"use strict";
// An image in a canvas with zoom, movement, a cross for the keyboard, and the marks of the pairs (pick.js).

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
    new ResizeObserver(() => this.fit()).observe(canvas);
  }

  resize(width, height) {
    this.width = width;
    this.height = height;
    this.cross = [width / 2, height / 2];
    this.whole = true; // shows the whole image, also when the pane's size changes
  }

  /** Takes over the canvas's size; shows the whole image unless the user has zoomed or moved it. */
  fit() {
    const box = this.canvas.getBoundingClientRect();
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.max(1, Math.round(box.width * ratio));
    this.canvas.height = Math.max(1, Math.round(box.height * ratio));
    if (this.whole) {
      this.zoom = Math.min(box.width / this.width, box.height / this.height) || 1;
      this.left = (box.width - this.width * this.zoom) / 2;
      this.top = (box.height - this.height * this.zoom) / 2;
    }
    this.draw();
  }

  showAll() {
    this.whole = true;
    this.fit();
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
    this.whole = false;
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
    this.whole = false;
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
    } else if (event.key === "0") this.showAll();
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
