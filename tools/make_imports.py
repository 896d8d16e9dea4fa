"""Writes assets/models/workshop: a room as a scanner sees it, with what stands in it, and assets/models/hill: a piece of rocky ground.

Both are what docs/import.md takes as a place and as a height field. Run it from anywhere; the files in the repository are its output, byte for byte.
"""

import math
import pathlib
import random

from make_lantern import Glb

MODELS = pathlib.Path(__file__).resolve().parent.parent / "assets" / "models"


class Shape:
    """Triangles with z up, flat unless normals are given."""

    def __init__(self):
        self.positions, self.normals, self.indices = [], [], []
        self.faces, self.known = [], {}

    def face(self, *corners):
        """A convex polygon, counter-clockwise from where it is seen."""
        at = [self.known.setdefault(corner, len(self.known)) for corner in corners]
        self.positions = list(self.known)
        self.faces.append(corners)
        for k in range(1, len(at) - 1):
            self.indices += [at[0], at[k], at[k + 1]]
        return self

    def box(self, low, high):
        c = [tuple((high if i >> k & 1 else low)[k] for k in range(3)) for i in range(8)]
        for f in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
            self.face(*(c[i] for i in f))
        return self

    def drum(self, x, y, low, high, radius, sides=24):
        ring = [(x + radius * math.cos(2 * math.pi * k / sides), y + radius * math.sin(2 * math.pi * k / sides)) for k in range(sides)]
        for k in range(sides):
            (x0, y0), (x1, y1) = ring[k], ring[(k + 1) % sides]
            self.face((x0, y0, low), (x1, y1, low), (x1, y1, high), (x0, y0, high))
        self.face(*((u, v, high) for u, v in ring))
        self.face(*((u, v, low) for u, v in reversed(ring)))
        return self


def primitive(g, shape, material):
    """glTF's y points up."""
    turned = [[(x, z, -y) for x, y, z in values] for values in (shape.positions, shape.normals)]
    attributes = {name: g.accessor(values, "VEC3", "f") for name, values in zip(("POSITION", "NORMAL"), turned) if values}
    return {"attributes": attributes, "indices": g.accessor(shape.indices, "SCALAR", "H"), "material": material}


def node(g, name, *parts):
    g.node(name, g.add("meshes", {"primitives": [primitive(g, shape, material) for shape, material in parts]}))


def material(g, name, color, roughness=0.7, metallic=0.0, **more):
    return g.add("materials", {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": metallic,
                                                                      "roughnessFactor": roughness}, **more})


def workshop():
    """5 x 4 x 2.5 m, seen from inside, with a window's recess in its north wall."""
    g = Glb("make_imports.py")
    white, plaster, floor = (material(g, *m) for m in (("white", (0.8, 0.8, 0.78)), ("plaster", (0.62, 0.6, 0.55)), ("floor", (1, 1, 1))))
    oak, steel, paint, red = (material(g, *m) for m in (("oak", (1, 1, 1), 0.5), ("steel", (0.6, 0.6, 0.62), 0.35, 1.0), ("paint", (0.05, 0.16, 0.22), 0.4),
                                                        ("red", (0.45, 0.06, 0.04), 0.45)))
    sky = material(g, "sky", (0, 0, 0), emissiveFactor=[0.86, 0.93, 1],
                   extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 900}})
    x0, x1, y0, y1, z1 = -2.5, 2.5, -2.0, 2.0, 2.5
    a, b, low, high, deep = -0.9, 0.9, 0.95, 2.15, 2.22         # of the recess
    walls = Shape().face((x0, y0, 0), (x0, y0, z1), (x1, y0, z1), (x1, y0, 0))
    walls.face((x0, y0, 0), (x0, y1, 0), (x0, y1, z1), (x0, y0, z1)).face((x1, y0, 0), (x1, y0, z1), (x1, y1, z1), (x1, y1, 0))
    for (u0, u1, w0, w1) in ((x0, a, 0, low), (a, b, 0, low), (b, x1, 0, low), (x0, a, low, high), (b, x1, low, high), (x0, a, high, z1),
                             (a, b, high, z1), (b, x1, high, z1)):
        walls.face((u0, y1, w0), (u1, y1, w0), (u1, y1, w1), (u0, y1, w1))
    # The walls' and the ceiling's edges are those of the strips beside the recess.
    walls = close_seams(walls)
    recess = Shape().face((a, y1, low), (b, y1, low), (b, deep, low), (a, deep, low)).face((a, y1, high), (a, deep, high), (b, deep, high), (b, y1, high))
    recess.face((a, y1, low), (a, deep, low), (a, deep, high), (a, y1, high)).face((b, y1, low), (b, y1, high), (b, deep, high), (b, deep, low))
    node(g, "room", (walls, plaster), (recess, white),
         (Shape().face((x0, y0, z1), (x0, y1, z1), (a, y1, z1), (b, y1, z1), (x1, y1, z1), (x1, y0, z1)), white),
         (Shape().face((x0, y0, 0), (x1, y0, 0), (x1, y1, 0), (b, y1, 0), (a, y1, 0), (x0, y1, 0)), floor),
         (Shape().face((a, deep, low), (b, deep, low), (b, deep, high), (a, deep, high)), sky))
    bars = Shape().box((-0.02, 2.14, low), (0.02, 2.18, high)).box((a, 2.145, 1.53), (-0.02, 2.175, 1.57)).box((0.02, 2.145, 1.53), (b, 2.175, 1.57))
    node(g, "window_bars", (bars, paint))
    bench = Shape().box((-0.85, 1.2, 0.8), (0.85, 1.9, 0.86))
    legs = Shape().box((-0.8, 1.25, 0.22), (0.8, 1.85, 0.25))
    for x in (-0.8, 0.74):
        for y in (1.25, 1.79):
            legs.box((x, y, 0), (x + 0.06, y + 0.06, 0.8))
    node(g, "workbench", (bench, oak), (legs, paint))
    shelf = Shape()
    for z in (0.08, 0.55, 1.02, 1.49):
        shelf.box((2.02, -1.5, z), (2.46, -0.1, z + 0.03))
    sides = Shape()
    for y in (-1.54, -0.1):
        sides.box((2.02, y, 0), (2.46, y + 0.04, 1.8))
    node(g, "shelf", (shelf, oak), (sides, paint))
    node(g, "crate_1", (Shape().box((2.08, -1.2, 0.58), (2.42, -0.75, 0.85)), oak))
    node(g, "crate_2", (Shape().box((2.08, -0.65, 1.05), (2.42, -0.25, 1.3)), red))
    node(g, "crate_3", (Shape().box((-1.7, 1.4, 0), (-1.2, 1.9, 0.42)), oak))
    skirting = Shape().box((-2.48, 1.985, 0), (1.2, 2, 0.09)).box((2.2, 1.985, 0), (2.48, 2, 0.09)).box((2.485, -2, 0), (2.5, 2, 0.09))
    skirting.box((-2.5, -2, 0), (-2.485, 2, 0.09)).box((-2.48, -2, 0), (2.48, -1.985, 0.09))
    node(g, "skirting", (skirting, white))
    frame = Shape().box((1.2, 1.95, 0), (1.27, 2, 2.07)).box((2.13, 1.95, 0), (2.2, 2, 2.07)).box((1.271, 1.951, 2), (2.129, 2, 2.069))
    handle = Shape().box((1.34, 1.925, 1.02), (1.37, 1.965, 1.05)).box((1.34, 1.91, 1.025), (1.47, 1.925, 1.045))
    node(g, "door", (frame, white), (Shape().box((1.275, 1.965, 0.005), (2.125, 1.995, 1.995)), paint), (handle, steel))
    node(g, "board", (Shape().box((2.46, 0.35, 1.05), (2.49, 1.55, 1.85)), oak))
    tools = Shape()
    for y, low, wide in ((0.5, 1.3, 0.03), (0.62, 1.38, 0.025), (0.75, 1.2, 0.04), (0.95, 1.45, 0.06), (1.15, 1.25, 0.03), (1.3, 1.4, 0.05)):
        tools.box((2.43, y, low), (2.455, y + wide, 1.7))
    node(g, "tools", (tools, steel))
    node(g, "drum", (Shape().drum(-2.05, 1.5, 0, 0.88, 0.29, 32), red))
    node(g, "post", (Shape().drum(1.3, -1.2, 0, 2.5, 0.06), steel))
    node(g, "vice", (Shape().box((-0.55, 1.22, 0.86), (-0.35, 1.5, 0.94)).box((-0.55, 1.22, 0.95), (-0.35, 1.3, 1.02)).box((-0.55, 1.36, 0.95), (-0.35, 1.44, 1.02)),
                     steel))
    return g.bytes()


def close_seams(walls):
    """West and east walls meet strips that are cut at the recess's sill and head: their edges are cut there, too."""
    out = Shape()
    for quad in walls.faces:
        corners = []
        for p, q in zip(quad, quad[1:] + quad[:1]):
            corners.append(p)
            if p[:2] == q[:2] and p[1] == 2.0 and abs(p[0]) == 2.5 and abs(p[2] - q[2]) == 2.5:
                corners += [(p[0], p[1], z) for z in ((0.95, 2.15) if q[2] > p[2] else (2.15, 0.95))]
        out.face(*corners)
    return out


def hill(side=12.0, steps=36):
    """Dunes with a rill through them, and boulders."""
    g = Glb("make_imports.py")
    soil, rock = material(g, "soil", (1, 1, 1), 0.95), material(g, "rock", (1, 1, 1), 0.9)

    def height(x, y):
        rill = 0.35 * math.exp(-((y - 1.1 - 0.5 * math.sin(0.8 * x)) / 0.4) ** 2)
        return 0.28 * math.sin(0.9 * x + 0.4) * math.cos(0.7 * y) + 0.07 * math.sin(2.3 * x - 1.7 * y) + 0.9 * math.exp(-((x - 3) ** 2 + (y + 2.5) ** 2) / 3) - rill

    ground = Shape()
    at = [side * (i / steps - 0.5) for i in range(steps + 1)]
    for y in at:
        for x in at:
            e = 0.01
            n = ((height(x - e, y) - height(x + e, y)) / (2 * e), (height(x, y - e) - height(x, y + e)) / (2 * e), 1)
            ground.positions.append((x, y, height(x, y)))
            ground.normals.append(tuple(v / math.hypot(*n) for v in n))
    for i in range(steps):
        for j in range(steps):
            k = i * (steps + 1) + j
            ground.indices += [k, k + 1, k + steps + 2, k, k + steps + 2, k + steps + 1]
    node(g, "ground", (ground, soil))
    rng = random.Random(11)
    for i in range(14):
        x, y, size = rng.uniform(-5, 5), rng.uniform(-5, 5), 0.08 + 0.3 * rng.random() ** 3
        if math.hypot(x + 1.5, y + 0.6) < 1.3:
            continue
        node(g, "boulder", (boulder(rng, x, y, height(x, y) + 0.1 * size, size), rock))
    return g.bytes()


def boulder(rng, x, y, z, size):
    """An octahedron that is divided twice, dented and flattened."""
    faces = [(a, b, c) if (a[0] or a[1] or a[2]) * (b[0] or b[1] or b[2]) * (c[0] or c[1] or c[2]) > 0 else (a, c, b)
             for a in ((1, 0, 0), (-1, 0, 0)) for b in ((0, 1, 0), (0, -1, 0)) for c in ((0, 0, 1), (0, 0, -1))]
    def unit(p):
        size = math.hypot(*p)
        return tuple(v / size for v in p)
    for _ in range(2):
        finer = []
        for a, b, c in faces:
            ab, bc, ca = (unit([(p + q) / 2 for p, q in zip(*pair)]) for pair in ((a, b), (b, c), (c, a)))
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    cuts = [(unit([rng.gauss(0, 1) for _ in range(3)]), rng.uniform(0.55, 0.85)) for _ in range(7)]
    stretch = (rng.uniform(0.8, 1.3), rng.uniform(0.8, 1.3), rng.uniform(0.6, 0.9))

    def place(p):
        far = min([1.0] + [d / max(sum(u * v for u, v in zip(p, n)), 1e-6) for n, d in cuts if sum(u * v for u, v in zip(p, n)) > 0])
        return tuple(c + size * far * s * v for c, s, v in zip((x, y, z), stretch, p))

    shape = Shape()
    for f in faces:
        shape.face(*(place(p) for p in f))
    return shape


def main():
    for name, make in (("workshop", workshop), ("hill", hill)):
        (MODELS / name).mkdir(parents=True, exist_ok=True)
        (MODELS / name / f"{name}.glb").write_bytes(make())


if __name__ == "__main__":
    main()
