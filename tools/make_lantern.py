"""Writes assets/models/lantern: a lantern as GLB, and the heights of hammered metal as PNG.

Shows what the importer takes: one mesh on several nodes, metal, clear coat, tinted thin glass, a glowing bulb, a picture.
Run it from anywhere; the files in the repository are its output, byte for byte.
"""

import json
import math
import pathlib
import random
import struct
import zlib

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "assets" / "models" / "lantern"


def png(width, height, channels, rows):
    """8-bit PNG; `rows` = bytes of each row from the top."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2}[channels], 0, 0, 0)
    packed = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")


def lathe(profile, sides=48):
    """Turns (radius, height) points about +Y. Edges of the profile stay sharp. (positions, normals, uvs, indices)"""
    positions, normals, uvs, indices = [], [], [], []
    length = sum(math.dist(a, b) for a, b in zip(profile, profile[1:]))
    along = 0.0
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        step = math.dist((r0, y0), (r1, y1))
        out, up = (y1 - y0) / step, (r0 - r1) / step
        first = len(positions)
        for k in range(sides + 1):
            angle = 2 * math.pi * k / sides
            c, s = math.cos(angle), math.sin(angle)
            for r, y, v in ((r0, y0, along), (r1, y1, along + step)):
                positions.append((r * c, y, -r * s))
                normals.append((out * c, up, -out * s))
                uvs.append((k / sides, 1 - v / length))
        for k in range(sides):
            a = first + 2 * k
            if r0 > 0:
                indices += [a, a + 2, a + 1]
            if r1 > 0:
                indices += [a + 1, a + 2, a + 3]
        along += step
    return positions, normals, uvs, indices


def ball(radius, rings=16):
    profile = [(radius * math.sin(math.pi * i / rings), -radius * math.cos(math.pi * i / rings)) for i in range(rings + 1)]
    profile[0], profile[-1] = (0, -radius), (0, radius)
    positions, _, uvs, indices = lathe(profile, 2 * rings)
    return positions, [tuple(x / radius for x in p) for p in positions], uvs, indices


def torus(radius, thickness, sides=14):
    turns = [2 * math.pi * k / sides for k in range(sides + 1)]
    positions, _, uvs, indices = lathe([(radius + thickness * math.cos(t), thickness * math.sin(t)) for t in turns])
    normals = []
    for x, y, z in positions:
        r = math.hypot(x, z)
        normals.append(((x - radius * x / r) / thickness, y / thickness, (z - radius * z / r) / thickness))
    return positions, normals, uvs, indices


class Glb:
    def __init__(self, maker="make_lantern.py"):
        self.data = b""
        self.json = {"asset": {"version": "2.0", "generator": f"Gloam tools/{maker}"}, "scene": 0, "scenes": [{"nodes": []}],
                     "nodes": [], "meshes": [], "materials": [], "accessors": [], "bufferViews": [], "buffers": [{}]}

    def add(self, kind, value):
        self.json.setdefault(kind, []).append(value)
        return len(self.json[kind]) - 1

    def view(self, data):
        self.data += b"\0" * (-len(self.data) % 4)
        at = len(self.data)
        self.data += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": at, "byteLength": len(data)})

    def accessor(self, values, kind, code):
        flat = [x for v in values for x in v] if kind != "SCALAR" else values
        data = struct.pack(f"<{len(flat)}{code}", *flat)
        out = {"bufferView": self.view(data), "componentType": {"f": 5126, "H": 5123}[code], "count": len(values), "type": kind}
        if kind == "VEC3":
            floats = [struct.unpack("<3f", struct.pack("<3f", *v)) for v in values]
            out["min"], out["max"] = [min(c) for c in zip(*floats)], [max(c) for c in zip(*floats)]
        return self.add("accessors", out)

    def mesh(self, shape, material):
        positions, normals, uvs, indices = shape
        attributes = {"POSITION": self.accessor(positions, "VEC3", "f"), "NORMAL": self.accessor(normals, "VEC3", "f"),
                      "TEXCOORD_0": self.accessor(uvs, "VEC2", "f")}
        return self.add("meshes", {"primitives": [{"attributes": attributes, "indices": self.accessor(indices, "SCALAR", "H"),
                                                   "material": material}]})

    def node(self, name, mesh, **more):
        self.json["scenes"][0]["nodes"].append(self.add("nodes", {"name": name, "mesh": mesh, **more}))

    def bytes(self):
        self.json["buffers"][0]["byteLength"] = len(self.data)
        used = sorted({name for m in self.json["materials"] for name in m.get("extensions", {})})
        self.json["extensionsUsed"] = used
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        data = self.data + b"\0" * (-len(self.data) % 4)
        return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text +
                struct.pack("<I4s", len(data), b"BIN\0") + data)


def stripes():
    """Two tones in rings, for the base's enamel."""
    rows = []
    for y in range(64):
        dark = (y // 4) % 4 == 0
        rows.append((150, 24, 20) * 4 if not dark else (225, 200, 160) * 4)
    return png(4, 64, 3, [sum((list(r[3 * i:3 * i + 3]) for i in range(4)), []) for r in rows])


def lantern():
    g = Glb()
    picture = g.add("images", {"bufferView": g.view(stripes()), "mimeType": "image/png", "name": "stripes"})
    texture = g.add("textures", {"source": picture})
    enamel = g.add("materials", {
        "name": "enamel", "pbrMetallicRoughness": {"baseColorTexture": {"index": texture}, "metallicFactor": 0, "roughnessFactor": 0.6},
        "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.03}}})
    copper = g.add("materials", {"name": "copper", "pbrMetallicRoughness": {
        "baseColorFactor": [0.955, 0.638, 0.538, 1], "metallicFactor": 1, "roughnessFactor": 0.25}})
    glass = g.add("materials", {
        "name": "glass", "doubleSided": True,
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0.86, 0.6, 1], "metallicFactor": 0, "roughnessFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}})
    bulb = g.add("materials", {
        "name": "bulb", "emissiveFactor": [1, 0.72, 0.42], "pbrMetallicRoughness": {"metallicFactor": 0},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 12000}}})
    g.node("base", g.mesh(lathe([(0, 0), (0.11, 0), (0.11, 0.015), (0.095, 0.05), (0.06, 0.06), (0, 0.06)]), enamel))
    g.node("cap", g.mesh(lathe([(0, 0.30), (0.105, 0.30), (0.105, 0.312), (0.07, 0.35), (0.03, 0.375), (0.0, 0.38)]), copper))
    g.node("glass", g.mesh(lathe([(0.075, 0.06), (0.075, 0.30)]), glass))
    g.node("bulb", g.mesh(ball(0.025), bulb), translation=[0, 0.16, 0])
    g.node("socket", g.mesh(lathe([(0.02, 0.06), (0.02, 0.135), (0, 0.135)], 24), copper))
    post = g.mesh(lathe([(0.006, 0.055), (0.006, 0.305)], 16), copper)
    for k in range(4):
        angle = math.pi / 4 + k * math.pi / 2
        g.node(f"post_{k}", post, translation=[0.09 * math.cos(angle), 0, 0.09 * math.sin(angle)])
    handle = g.mesh(torus(0.045, 0.005), copper)
    g.node("handle", handle, translation=[0, 0.42, 0], rotation=[math.sqrt(0.5), 0, 0, math.sqrt(0.5)])
    return g.bytes()


def hammered(size=128, blows=90):
    """Heights of overlapping round dents that repeat over the edges."""
    rng = random.Random(7)
    spots = [(rng.random(), rng.random(), 0.05 + 0.04 * rng.random()) for _ in range(blows)]
    rows = []
    for y in range(size):
        row = []
        for x in range(size):
            deepest = 0.0
            for u, v, r in spots:
                dx, dy = (x / size - u + 0.5) % 1 - 0.5, (y / size - v + 0.5) % 1 - 0.5
                deepest = max(deepest, 1 - (dx * dx + dy * dy) / (r * r))
            row.append(round(255 * (1 - 0.9 * max(deepest, 0.0))))
        rows.append(row)
    return png(size, size, 1, rows)


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "lantern.glb").write_bytes(lantern())
    (FOLDER / "hammered.png").write_bytes(hammered())


if __name__ == "__main__":
    main()
