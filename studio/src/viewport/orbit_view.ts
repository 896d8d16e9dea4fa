import * as three from "three";
import type { Vector } from "../protocol";
import { image } from "../view/images";
import type { LocalCamera } from "../view/mouse";

/** The camera of “Draw here”: it orbits a pivot, Z up, and begins where the server's image was taken. */
export class OrbitView {
  aspect = 1;
  private readonly view = new three.PerspectiveCamera(45, 1, 0.01, 10_000);
  private readonly pivot = new three.Vector3(0, 0, 0.5);
  private azimuth = -Math.PI / 3;
  private elevation = Math.PI / 7;
  private distance = 4;

  constructor() {
    this.view.up.set(0, 0, 1);
    const shown = image.peek();
    if (!shown) return;
    const [w, x, y, z] = shown.quaternion;
    const back = new three.Vector3(0, 0, 1).applyQuaternion(new three.Quaternion(x, y, z, w));
    this.azimuth = Math.atan2(back.y, back.x);
    this.elevation = Math.asin(Math.max(-1, Math.min(1, back.z)));
    this.pivot.set(...shown.position).addScaledVector(back, -this.distance);
  }

  camera(): three.PerspectiveCamera {
    const { view, pivot, azimuth, elevation, distance } = this;
    const level = Math.cos(elevation);
    view.aspect = this.aspect;
    view.position.set(level * Math.cos(azimuth), level * Math.sin(azimuth), Math.sin(elevation)).multiplyScalar(distance).add(pivot);
    view.lookAt(pivot);
    view.updateProjectionMatrix();
    view.updateMatrixWorld();
    return view;
  }

  gestures(pick: LocalCamera["pick"], redraw: () => void): LocalCamera {
    const limit = Math.PI / 2 - 0.01;
    return {
      pick,
      orbit: (dx, dy) => {
        this.azimuth -= Math.PI * dx;
        this.elevation = Math.max(-limit, Math.min(limit, this.elevation + Math.PI * dy));
        redraw();
      },
      pan: (dx, dy) => {
        const height = 2 * this.distance * Math.tan(this.view.fov * Math.PI / 360);
        const right = new three.Vector3().setFromMatrixColumn(this.view.matrixWorld, 0), up = new three.Vector3().setFromMatrixColumn(this.view.matrixWorld, 1);
        this.pivot.addScaledVector(right, -dx * height).addScaledVector(up, dy * height);
        redraw();
      },
      zoom: (amount) => {
        this.distance = Math.max(0.01, Math.min(10_000, this.distance * Math.exp(-amount)));
        redraw();
      },
      look_at: (point: Vector) => {
        this.pivot.set(...point);
        redraw();
      },
    };
  }
}
