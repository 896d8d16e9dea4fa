import { effect } from "@preact/signals";
import * as three from "three";
import { constants_count, watch, watch_count } from "../fields";
import { draw_here, geom_groups, overlays_on, site_groups } from "../settings";
import { link_state, selection, serial, show_notice } from "../state";
import { kPinhole } from "../protocol";
import { image } from "../view/images";
import { image_box, set_local_camera } from "../view/mouse";
import { OrbitView } from "./orbit_view";
import { GeomScene } from "./geoms";
import { draw_overlays, fields_of_overlays } from "./overlay_list";
import { Labels } from "./labels";
import { Lines } from "./lines";

// Draws overlays over the image of the server with the camera of the image, or the whole scene with a camera of its own.

export function start_viewport(canvas: HTMLCanvasElement, label_canvas: HTMLCanvasElement): () => void {
  const stage = document.getElementById("stage")!;
  const renderer = new three.WebGLRenderer({ canvas, alpha: true, antialias: true });
  const scene = new three.Scene(), lines = new Lines(), geoms = new GeomScene(), labels = new Labels(label_canvas);
  const own = new OrbitView();
  scene.add(lines.object, geoms.object, new three.HemisphereLight(0xffffff, 0x6b6255, 1.1));
  const sun = new three.DirectionalLight(0xffffff, 1.3);
  sun.position.set(2, -3, 5);
  scene.add(sun);

  let queued = false;
  function redraw() {
    if (queued) return;
    queued = true;
    requestAnimationFrame(draw);
  }
  function draw() {
    queued = false;
    const shown = image.peek(), here = draw_here.peek();
    if (!here && (!shown || shown.lens !== kPinhole)) return renderer.clear();
    resize(here);
    own.aspect = stage.clientWidth / Math.max(1, stage.clientHeight);
    const camera = here ? own.camera() : image_camera();
    geoms.object.visible = here;
    if (here) geoms.update(geom_groups.peek(), selection.peek()?.id ?? -1);
    lines.begin(renderer);
    labels.begin(camera, renderer);
    draw_overlays(overlays_on.peek(), { lines, labels, selected: selection.peek()?.id ?? -1, geom_groups: geom_groups.peek(), site_groups: site_groups.peek() });
    lines.end();
    renderer.render(scene, camera);
  }
  function resize(here: boolean) {
    const box = image_box(stage), ratio = window.devicePixelRatio;
    const width = here ? stage.clientWidth : box.scale * box.width, height = here ? stage.clientHeight : box.scale * box.height;
    const size = renderer.getSize(new three.Vector2());
    if (Math.abs(size.x - width) < 0.5 && Math.abs(size.y - height) < 0.5) return;
    renderer.setPixelRatio(ratio);
    renderer.setSize(width, height, false);
    labels.resize(width, height, ratio);
  }

  set_local_camera(own.gestures((x, y) => geoms.pick(own.camera(), x, y), redraw));
  let unwatch = () => {};
  const effects = [
    effect(() => {
      serial.value;
      unwatch();
      unwatch = watch(fields_of_overlays(overlays_on.value, draw_here.value));
    }),
    effect(() => {
      image.value, watch_count.value, constants_count.value, overlays_on.value, geom_groups.value, site_groups.value, draw_here.value, selection.value, link_state.value;
      redraw();
    }),
    effect(() => {
      if (image.value && image.value.lens !== kPinhole && !draw_here.value && overlays_on.value.length)
        show_notice("Overlays are drawn in images of pinhole cameras only. Choose another camera.");
    }),
  ];
  const observer = new ResizeObserver(redraw);
  observer.observe(stage);
  document.addEventListener("redraw_view", draw);
  return () => {
    set_local_camera(null);
    unwatch();
    for (const dispose of effects) dispose();
    observer.disconnect();
    document.removeEventListener("redraw_view", draw);
    renderer.dispose();
  };
}

/** The camera of the newest image (docs/view_protocol.md). */
function image_camera(): three.Camera {
  const shown = image.peek()!, camera = new three.Camera();
  const { fx, fy, cx, cy, width: w, height: h } = shown, near = 0.01, far = 10_000;
  const depth = [-(far + near) / (far - near), -2 * far * near / (far - near)];
  camera.projectionMatrix = shown.orthographic
    ? new three.Matrix4(2 * fx / w, 0, 0, 2 * cx / w - 1, 0, 2 * fy / h, 0, 1 - 2 * cy / h, 0, 0, -2 / far, -1, 0, 0, 0, 1)
    : new three.Matrix4(2 * fx / w, 0, 1 - 2 * cx / w, 0, 0, 2 * fy / h, 2 * cy / h - 1, 0, 0, 0, depth[0], depth[1], 0, 0, -1, 0);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  const [qw, qx, qy, qz] = shown.quaternion;
  camera.position.set(...shown.position);
  camera.quaternion.set(qx, qy, qz, qw);
  camera.updateMatrixWorld();
  return camera;
}
