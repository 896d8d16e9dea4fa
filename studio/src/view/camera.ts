import type { ImageHeader, Vector } from "../protocol";

// Projection of points in the world into an image, for every lens of docs/cameras.md.

/** Position in the image, in focal lengths, of the direction (x, y, z): right, down, ahead. Null behind the camera. */
function through_lens({ orthographic, lens, coefficients: d }: ImageHeader, x: number, y: number, z: number): [number, number] | null {
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

/** Axes of the camera in the world: right, up, back. */
export function camera_axes([w, x, y, z]: ImageHeader["quaternion"]): [Vector, Vector, Vector] {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];
}

/** Pixel of a point in the world, or null if it lies behind the camera. */
export function project(image: ImageHeader, point: Vector): { u: number; v: number } | null {
  const d = point.map((value, i) => value - image.position[i]);
  const along = (axis: Vector) => axis[0] * d[0] + axis[1] * d[1] + axis[2] * d[2];
  const [right, up, back] = camera_axes(image.quaternion).map(along);
  const at = through_lens(image, right, -up, -back);
  return at && { u: image.cx + image.fx * at[0], v: image.cy + image.fy * at[1] };
}
