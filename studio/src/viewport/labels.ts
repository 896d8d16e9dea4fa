import * as three from "three";
import type { Vector } from "../protocol";

/** Texts at points of the world. */
export class Labels {
  private readonly context: CanvasRenderingContext2D;
  private camera: three.Camera | null = null;
  private width = 1;
  private height = 1;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.context = canvas.getContext("2d")!;
  }

  resize(width: number, height: number, ratio: number) {
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.context.scale(ratio, ratio);
    [this.width, this.height] = [width, height];
  }

  begin(camera: three.Camera, renderer: three.WebGLRenderer) {
    const size = renderer.getSize(new three.Vector2());
    if (Math.abs(size.x - this.width) > 0.5 || Math.abs(size.y - this.height) > 0.5) this.resize(size.x, size.y, renderer.getPixelRatio());
    this.camera = camera;
    this.context.clearRect(0, 0, this.width, this.height);
    this.context.font = "12px system-ui, sans-serif";
    this.context.textAlign = "center";
  }

  text(at: Vector, text: string) {
    const p = new three.Vector3(...at).applyMatrix4(this.camera!.matrixWorldInverse);
    if (p.z >= 0) return;
    p.applyMatrix4(this.camera!.projectionMatrix);
    const x = 0.5 * (1 + p.x) * this.width, y = 0.5 * (1 - p.y) * this.height;
    this.context.lineWidth = 3;
    this.context.strokeStyle = "#000b";
    this.context.strokeText(text, x, y);
    this.context.fillStyle = "#fff";
    this.context.fillText(text, x, y);
  }
}
