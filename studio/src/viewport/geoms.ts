import * as three from "three";
import { live_field, model_field } from "../fields";
import type { Vector } from "../protocol";

// The geoms of the model as three.js meshes, for “Draw here”.

const kPlane = 0, kHeightField = 1, kSphere = 2, kCapsule = 3, kEllipsoid = 4, kCylinder = 5, kBox = 6, kMesh = 7;  // mjtGeom
const kInfinitePlane = 50;  // half size of planes without one [m]
const kDefaultColour = [0.5, 0.5, 0.5, 1];

export const kGeomFields = ["geom_xpos", "geom_xmat"];
const model = Object.fromEntries([
  "geom_type", "geom_size", "geom_dataid", "geom_bodyid", "geom_group", "geom_rgba", "geom_matid", "mat_rgba", "mesh_vert", "mesh_vertadr", "mesh_vertnum",
  "mesh_face", "mesh_faceadr", "mesh_facenum", "hfield_size", "hfield_nrow", "hfield_ncol", "hfield_adr", "hfield_data",
].map((name) => [name, () => model_field(name).value])) as Record<string, () => Float32Array>;

export class GeomScene {
  readonly object = new three.Group();
  private built: Float32Array | null = null;  // geom_type of the model that was built
  private readonly meshes: three.Mesh[] = [];

  constructor() {
    for (const read of Object.values(model)) read();  // requests all fields, which come in one reply
  }

  update(groups: boolean[], selected: number) {
    const types = model.geom_type();
    if (types.length && types !== this.built && model.geom_size().length && model.geom_rgba().length) this.build(types);
    const positions = live_field("geom_xpos").value, rotations = live_field("geom_xmat").value;
    const group = model.geom_group(), bodies = model.geom_bodyid();
    this.meshes.forEach((mesh, i) => {
      mesh.visible = groups[group[i]] ?? false;
      if (3 * i + 2 < positions.length) place(mesh, positions, rotations, i);
      (mesh.material as three.MeshStandardMaterial).emissive.setHex(bodies[i] === selected && selected > 0 ? 0x5a4210 : 0);
    });
  }

  private build(types: Float32Array) {
    const has_meshes = [...types].some((type) => type === kMesh);
    if ((has_meshes && !model.mesh_vertadr().length) || !model.geom_dataid().length) return;
    this.built = types;
    this.object.clear();
    this.meshes.length = 0;
    const shapes = new Map<string, three.BufferGeometry>();
    types.forEach((type, i) => {
      const size = model.geom_size().subarray(3 * i, 3 * i + 3), data = model.geom_dataid()[i];
      const key = type === kMesh || type === kHeightField ? `${type} ${data}` : `${type} ${size.join()}`;
      if (!shapes.has(key)) shapes.set(key, shape_of(type, size, data));
      const [r, g, b, a] = colour_of(i);
      const material = new three.MeshStandardMaterial({ color: new three.Color(r, g, b), opacity: a, transparent: a < 1, roughness: 0.7, side: three.DoubleSide });
      const mesh = new three.Mesh(shapes.get(key)!, material);
      mesh.matrixAutoUpdate = false;
      mesh.userData.body = model.geom_bodyid()[i];
      this.meshes.push(mesh);
      this.object.add(mesh);
    });
  }

  /** Body and point under a position in [−1, 1]². */
  pick(camera: three.Camera, x: number, y: number): { body: number; point: Vector } | null {
    const ray = new three.Raycaster();
    ray.setFromCamera(new three.Vector2(x, y), camera);
    const hit = ray.intersectObjects(this.meshes.filter(({ visible }) => visible))[0];
    return hit ? { body: hit.object.userData.body, point: hit.point.toArray() as Vector } : null;
  }
}

function place(mesh: three.Object3D, p: Float32Array, R: Float32Array, i: number) {
  const m = R.subarray(9 * i, 9 * i + 9);
  mesh.matrix.set(m[0], m[1], m[2], p[3 * i], m[3], m[4], m[5], p[3 * i + 1], m[6], m[7], m[8], p[3 * i + 2], 0, 0, 0, 1);
  mesh.matrixWorldNeedsUpdate = true;
}

function colour_of(geom: number): Float32Array {
  const rgba = model.geom_rgba().subarray(4 * geom, 4 * geom + 4), material = model.geom_matid()[geom];
  const is_default = kDefaultColour.every((value, k) => Math.abs(rgba[k] - value) < 1e-6);
  return is_default && material >= 0 ? model.mat_rgba().subarray(4 * material, 4 * material + 4) : rgba;
}

/** Shapes of MuJoCo: axes of capsules and cylinders along Z, sizes as halves. */
export function shape_of(type: number, size: ArrayLike<number>, data: number): three.BufferGeometry {
  const [a, b, c] = [size[0], size[1], size[2]];
  switch (type) {
    case kPlane: return new three.PlaneGeometry(2 * (a || kInfinitePlane), 2 * (b || kInfinitePlane));
    case kSphere: return new three.SphereGeometry(a, 24, 16);
    case kCapsule: return new three.CapsuleGeometry(a, 2 * b, 8, 20).rotateX(Math.PI / 2);
    case kEllipsoid: return new three.SphereGeometry(1, 24, 16).scale(a, b, c);
    case kCylinder: return new three.CylinderGeometry(a, a, 2 * b, 28).rotateX(Math.PI / 2);
    case kBox: return new three.BoxGeometry(2 * a, 2 * b, 2 * c);
    case kMesh: return mesh_shape(data);
    case kHeightField: return height_field_shape(data);
    default: return new three.SphereGeometry(Math.max(a, 0.01), 12, 8);
  }
}

function mesh_shape(mesh: number): three.BufferGeometry {
  const shape = new three.BufferGeometry();
  const first = model.mesh_vertadr()[mesh], faces = model.mesh_faceadr()[mesh];
  const vertices = model.mesh_vert().slice(3 * first, 3 * (first + model.mesh_vertnum()[mesh]));
  shape.setAttribute("position", new three.BufferAttribute(vertices, 3));
  shape.setIndex([...model.mesh_face().subarray(3 * faces, 3 * (faces + model.mesh_facenum()[mesh]))]);
  shape.computeVertexNormals();
  return shape;
}

function height_field_shape(field: number): three.BufferGeometry {
  const rows = model.hfield_nrow()[field], columns = model.hfield_ncol()[field], first = model.hfield_adr()[field];
  const [rx, ry, top] = model.hfield_size().subarray(4 * field, 4 * field + 3);
  const shape = new three.PlaneGeometry(2 * rx, 2 * ry, columns - 1, rows - 1), positions = shape.getAttribute("position");
  for (let row = 0; row < rows; ++row)
    for (let column = 0; column < columns; ++column)  // rows of three.js begin at the top, those of MuJoCo at −y
      positions.setZ((rows - 1 - row) * columns + column, top * model.hfield_data()[first + row * columns + column]);
  shape.computeVertexNormals();
  return shape;
}
