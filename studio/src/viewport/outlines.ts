import { to_world, type Colour, type Frame, type Lines } from "./lines";

const kPlane = 0, kSphere = 2, kCapsule = 3, kEllipsoid = 4, kCylinder = 5, kBox = 6;  // mjtGeom

/** The outline of a shape of MuJoCo. Meshes and height fields are shown by their bounding box: centre and half sizes. */
export function outline(lines: Lines, type: number, size: ArrayLike<number>, frame: Frame, colour: Colour, box?: ArrayLike<number>) {
  const [a, b, c] = [size[0], size[1], size[2]];
  if (type === kBox) return lines.box(frame, [a, b, c], colour);
  if (type === kPlane) return lines.box(frame, [a || 10, b || 10, 0], colour);
  if (type === kSphere || type === kEllipsoid) return ellipsoid(lines, frame, [a, type === kSphere ? a : b, type === kSphere ? a : c], colour);
  if (type === kCapsule || type === kCylinder) return round(lines, frame, a, b, type === kCapsule, colour);
  if (!box || box.length < 6) return;
  lines.box({ ...frame, p: to_world(frame, box[0], box[1], box[2]) }, [box[3], box[4], box[5]], colour);
}

function ellipsoid(lines: Lines, { p, R }: Frame, [a, b, c]: [number, number, number], colour: Colour) {
  const columns = [[R[0], R[3], R[6]], [R[1], R[4], R[7]], [R[2], R[5], R[8]]], radii = [a, b, c];
  for (const [i, j] of [[0, 1], [1, 2], [2, 0]]) {
    const u = columns[i].map((value) => value * radii[i]), v = columns[j].map((value) => value * radii[j]), w = columns[3 - i - j];
    lines.circle({ p, R: [u[0], v[0], w[0], u[1], v[1], w[1], u[2], v[2], w[2]] }, 1, colour);
  }
}

function round(lines: Lines, frame: Frame, radius: number, half: number, capsule: boolean, colour: Colour) {
  for (const height of [-half, half]) lines.circle(frame, radius, colour, height);
  for (const [x, y] of [[radius, 0], [-radius, 0], [0, radius], [0, -radius]]) lines.segment(to_world(frame, x, y, -half), to_world(frame, x, y, half), colour);
  if (!capsule) return;
  const kParts = 8;
  for (const [x, y] of [[1, 0], [0, 1]])
    for (const end of [-1, 1]) {
      const at = (k: number) => {
        const angle = Math.PI * k / kParts;
        return to_world(frame, x * radius * Math.cos(angle), y * radius * Math.cos(angle), end * (half + radius * Math.sin(angle)));
      };
      for (let k = 0; k < kParts; ++k) lines.segment(at(k), at(k + 1), colour);
    }
}
