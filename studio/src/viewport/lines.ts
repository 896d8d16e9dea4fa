import * as three from "three";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import type { Vector } from "../protocol";

export type Colour = readonly [number, number, number];
export const kAxes: readonly Colour[] = [[0.95, 0.3, 0.3], [0.35, 0.8, 0.35], [0.4, 0.55, 1]];

/** A pose in the world: origin and rotation matrix by rows, as in MuJoCo's arrays. */
export interface Frame { p: ArrayLike<number>; R: ArrayLike<number> }

export function frame_of(positions: Float32Array, rotations: Float32Array, i: number): Frame {
  return { p: positions.subarray(3 * i, 3 * i + 3), R: rotations.subarray(9 * i, 9 * i + 9) };
}

export function to_world({ p, R }: Frame, x: number, y: number, z: number): Vector {
  return [p[0] + R[0] * x + R[1] * y + R[2] * z, p[1] + R[3] * x + R[4] * y + R[5] * z, p[2] + R[6] * x + R[7] * y + R[8] * z];
}

/** Segments of all overlays, collected anew for each image. */
export class Lines {
  readonly object: LineSegments2;
  private readonly material = new LineMaterial({ vertexColors: true, linewidth: 2, depthTest: false, transparent: true });
  private positions: number[] = [];
  private colours: number[] = [];

  constructor() {
    this.object = new LineSegments2(new LineSegmentsGeometry(), this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 1;
  }

  begin(renderer: three.WebGLRenderer) {
    renderer.getSize(this.material.resolution);
    this.positions = [];
    this.colours = [];
  }

  end() {
    this.object.geometry.dispose();
    this.object.geometry = new LineSegmentsGeometry();
    this.object.visible = this.positions.length > 0;
    if (!this.object.visible) return;
    this.object.geometry.setPositions(this.positions);
    this.object.geometry.setColors(this.colours);
  }

  /** A segment with a number that has not arrived yet is left out. */
  segment(a: ArrayLike<number>, b: ArrayLike<number>, colour: Colour) {
    if (!Number.isFinite(a[0] + a[1] + a[2] + b[0] + b[1] + b[2])) return;
    this.positions.push(a[0], a[1], a[2], b[0], b[1], b[2]);
    this.colours.push(...colour, ...colour);
  }

  arrow(from: Vector, to: Vector, colour: Colour) {
    this.segment(from, to, colour);
    const d = new three.Vector3(...to).sub(new three.Vector3(...from)), length = d.length();
    if (length < 1e-9) return;
    d.divideScalar(length);
    const side = new three.Vector3(Math.abs(d.z) < 0.9 ? 0 : 1, 0, Math.abs(d.z) < 0.9 ? 1 : 0).cross(d).normalize(), other = side.clone().cross(d);
    const head = Math.min(0.25 * length, 0.05);
    for (const across of [side, other, side.clone().negate(), other.clone().negate()]) {
      const at = new three.Vector3(...to).addScaledVector(d, -head).addScaledVector(across, 0.4 * head);
      this.segment(to, at.toArray(), colour);
    }
  }

  axes(frame: Frame, length: number) {
    kAxes.forEach((colour, k) => this.segment(frame.p, to_world(frame, k === 0 ? length : 0, k === 1 ? length : 0, k === 2 ? length : 0), colour));
  }

  box(frame: Frame, [x, y, z]: ArrayLike<number> & Iterable<number>, colour: Colour) {
    const corner = (i: number) => to_world(frame, i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z);
    for (let i = 0; i < 8; ++i)
      for (const bit of [1, 2, 4]) if (!(i & bit)) this.segment(corner(i), corner(i | bit), colour);
  }

  /** A circle about the frame's Z axis. */
  circle(frame: Frame, radius: number, colour: Colour, height = 0) {
    const kParts = 20;
    const at = (k: number) => to_world(frame, radius * Math.cos(2 * Math.PI * k / kParts), radius * Math.sin(2 * Math.PI * k / kParts), height);
    for (let k = 0; k < kParts; ++k) this.segment(at(k), at(k + 1), colour);
  }
}
