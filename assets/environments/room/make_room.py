"""Generates the furnished room: room.xml, meshes/*.obj, textures/*.png. Needs numpy only.

    python3 make_room.py

The same numpy version gives the same bytes. Frame: Z up, metres, origin on the floor in the middle
of the free walking area; the window looks to -y, the door is in the wall at +y.
"""

import pathlib
import shutil
import sys

import numpy as np

import fittings
import furniture
import shell
import textures
from materials import MATERIALS

SUN = {"dir": (0.40, 0.68, -0.62), "lux": 2000, "rgb": (1.0, 0.95, 0.86)}
SKY_LUMINANCE = 300  # of a white texel [cd/m²]


def pieces():
    rng = np.random.default_rng(7)
    X, Y = shell.HALF_X, shell.HALF_Y
    all_pieces = [
        shell.floor(rng),
        *shell.walls(),
        shell.skirting(),
        shell.door(),
        shell.window(),
        shell.rug(),
        shell.outdoors(rng),
    ]
    x0, x1, _, top = shell.WINDOW
    all_pieces += [
        furniture.sofa((-X + 0.46, 0.15, 0), 0),
        furniture.coffee_table((-1.93, 0.05, 0), 0),
        furniture.dining_table((2.52, -1.42, 0), 0),
        furniture.chair(1, (2.50, -0.62, 0), -94),
        furniture.chair(2, (1.98, -1.22, 0), 3),
        furniture.chair(3, (1.93, -1.78, 0), -12),
        furniture.chair(4, (2.56, -2.22, 0), 88),
        furniture.bookshelf((-0.35, Y - 0.165, 0), -90, rng),
        furniture.tv_stand((X - 0.225, 0.98, 0), 180),
        furniture.television((X - 0.24, 0.84, 0.531), 180),
        furniture.plant("plant", (-X + 0.42, -Y + 0.45, 0), rng),
        fittings.floor_lamp((-X + 0.34, Y - 0.95, 0)),
        fittings.table_lamp((X - 0.22, 1.55, 0.531)),
        fittings.pendant_lamp((0.1, 0.1, shell.HEIGHT), 0.56, 0.27),
        fittings.curtain("curtain_left", (x0 - 0.16, -Y + 0.10, 0), 0.62, 2.33, 3),
        fittings.curtain("curtain_right", (x1 + 0.16, -Y + 0.10, 0), 0.62, 2.33, 4),
        fittings.curtain_rod(((x0 + x1) / 2, -Y + 0.10, 2.345), 2.75),
        fittings.radiator(((x0 + x1) / 2, -Y + 0.075, 0), 90),
        fittings.picture("picture_1", "art_hills", (-X, 0.62, 1.55), 0, 0.60, 0.75, "oak"),
        fittings.picture("picture_2", "art_discs", (-X, -0.28, 1.55), 0, 0.60, 0.75, "oak"),
        fittings.picture("picture_3", "art_bands", (0.95, Y, 1.50), -90, 0.50, 0.62, "black_metal"),
        fittings.picture("picture_4", "art_night", (X, -1.42, 1.52), 180, 0.72, 0.90, "oak"),
        fittings.wall_shelf((X, 0.80, 1.50), 180, rng),
        fittings.pouf((-1.75, Y - 0.62, 0)),
        fittings.basket((X - 0.24, -0.06, 0)),
        fittings.cardboard_box((1.12, -Y + 0.42, 0), 14),
        fittings.toy_ball((1.32, 1.62), 0.11),
        fittings.toy_block("G", (-0.98, 1.62, 0), 12),
        fittings.toy_block("L", (-1.12, 1.50, 0), -35),
        fittings.toy_block("O", (-0.86, 1.47, 0), 61),
        fittings.toy_block("A", (-1.02, 1.36, 0), -8),
        fittings.toy_block("M", (-0.985, 1.625, 0.06), 31),
        fittings.toy_car((-1.42, 1.42, 0), 38),
        fittings.remote((-1.97, 0.36, 0.40), 70),
        fittings.lying_book(
            "floor_book_1", (-X + 0.30, 1.36, 0), 12, (0.23, 0.30, 0.035), (0.20, 0.26, 0.34)
        ),
        fittings.lying_book(
            "floor_book_2", (-X + 0.31, 1.365, 0.035), -6, (0.20, 0.27, 0.028), (0.62, 0.44, 0.22)
        ),
        fittings.lying_book(
            "floor_book_3", (-X + 0.30, 1.36, 0.063), 24, (0.17, 0.24, 0.022), (0.56, 0.54, 0.50)
        ),
        fittings.mug("mug", (-1.86, 0.36, 0.40), "glazed_rust"),
        fittings.lying_book(
            "magazine_1", (-1.95, -0.08, 0.40), 8, (0.21, 0.28, 0.018), (0.10, 0.24, 0.34)
        ),
        fittings.lying_book(
            "magazine_2", (-1.94, -0.07, 0.418), -9, (0.19, 0.26, 0.024), (0.72, 0.30, 0.16)
        ),
        fittings.lying_book(
            "album", (-1.93, 0.1, 0.145), 4, (0.24, 0.32, 0.03), (0.30, 0.36, 0.24)
        ),
        fittings.fruit_bowl((2.50, -1.32, 0.74)),
        fittings.mug("cup", (2.36, -1.72, 0.74), "ceramic_white"),
        fittings.cable(
            "lamp_cable",
            [
                (-X + 0.34, Y - 0.83, 0.005),
                (-X + 0.27, Y - 0.62, 0.005),
                (-X + 0.14, Y - 0.48, 0.005),
                (-X + 0.03, Y - 0.42, 0.05),
                (-X + 0.02, Y - 0.41, 0.26),
                (-X + 0.01, Y - 0.41, 0.30),
            ],
        ),
        fittings.socket("socket_1", (-X, Y - 0.41, 0.30), 0),
        fittings.socket("socket_2", (X, -0.28, 0.30), 180),
        fittings.cable(
            "tv_cable",
            [
                (X - 0.02, -0.28, 0.30),
                (X - 0.05, -0.27, 0.12),
                (X - 0.06, -0.12, 0.01),
                (X - 0.05, 0.12, 0.005),
                (X - 0.07, 0.32, 0.01),
                (X - 0.03, 0.45, 0.3),
            ],
        ),
    ]
    mat = shell.Piece("doormat", (2.3, Y - 0.42, 0))
    mat.show("pile", "doormat", shell.box((0.70, 0.42, 0.010), 0.004, 2).moved(0, 0, 0.003))
    return all_pieces + [mat]


def numbers(values, digits=5):
    return " ".join(
        f"{v:.{digits}f}".rstrip("0").rstrip(".") or "0" for v in np.asarray(values, float) + 0.0
    )


def quaternion(euler):
    """Extrinsic x, y, z degrees to MuJoCo's w, x, y, z."""
    q = np.array([1.0, 0, 0, 0])
    for axis, angle in enumerate(np.radians(euler) / 2):
        w, v = np.cos(angle), np.eye(3)[axis] * np.sin(angle)
        q = np.concatenate([[w * q[0] - v @ q[1:]], w * q[1:] + q[0] * v + np.cross(v, q[1:])])
    return numbers(q, 6)


def attributes(**values):
    return "".join(f' {k.rstrip("_")}="{v}"' for k, v in values.items() if v not in ("", None))


def placed(pos, euler):
    return {
        "pos": numbers(pos) if any(pos) else "",
        "quat": quaternion(euler) if any(euler) else "",
    }


def body_xml(piece, assets):
    lines = [f"    <body{attributes(name=piece.name, **placed(piece.pos, (0, 0, piece.yaw)))}>"]
    if piece.mass:
        lines.append(f'      <freejoint name="{piece.name}"/>')
    for v in piece.visuals:
        name = (
            v.name
            if v.name.startswith(piece.name) or "book_" in v.name
            else f"{piece.name}_{v.name}"
        )
        shape = (
            {"type": v.primitive, "size": numbers(v.size)}
            if v.primitive
            else {"type": "mesh", "mesh": assets[id(v)]}
        )
        lines.append(
            "      <geom"
            + attributes(
                class_="room_visual",
                name=name,
                **shape,
                material=v.material,
                **placed(v.pos, v.euler),
                rgba=numbers(v.rgba) if v.rgba else "",
            )
            + "/>"
        )
    for k, c in enumerate(piece.colliders):
        mass = piece.mass / len(piece.colliders) if piece.mass else ""
        lines.append(
            "      <geom"
            + attributes(
                class_="room_collider",
                name=f"{piece.name}_collider_{k + 1}",
                type=c.type,
                size=numbers(c.size),
                **placed(c.pos, c.euler),
                mass=mass,
                friction=c.friction,
            )
            + "/>"
        )
    return lines + ["    </body>"]


def material_xml(name, m):
    head = "    <material" + attributes(
        name=name,
        rgba=numbers((*m.rgba, 1)),
        roughness=m.roughness,
        metallic=m.metallic,
        emission=m.emission or "",
        specular=0.3,
        shininess=round(0.6 * (1 - m.roughness), 3),
    )
    if not m.layers:
        return [head + "/>"]
    return (
        [head + ">"]
        + [f'      <layer role="{r}" texture="{t}"/>' for r, t in m.layers.items()]
        + ["    </material>"]
    )


def write_meshes(all_pieces, folder):
    """Writes each mesh asset once; returns ({id(visual): asset}, [asset names])."""
    assets, names = {}, []
    for piece in all_pieces:
        for v in piece.visuals:
            if v.mesh is None:
                continue
            name = v.asset or f"{piece.name}_{v.name}"
            assets[id(v)] = name
            if name not in names:
                tile = MATERIALS[v.material].tile
                (v.mesh.textured(tile) if tile else v.mesh).write(folder / f"{name}.obj")
                names.append(name)
    return assets, names


def scene_xml(all_pieces, assets, meshes):
    used = sorted({t for m in MATERIALS.values() for t in m.layers.values()})
    x = [
        '<mujoco model="furnished_room">',
        "  <!-- Generated by make_room.py: edit that, not this. -->",
        '  <compiler angle="degree" meshdir="meshes" texturedir="textures"/>',
        '  <statistic center="0 0 1" extent="4"/>',
        "  <visual>",
        '    <headlight active="0"/>',
        "  </visual>",
        "  <default>",
        '    <default class="room_visual">',
        '      <geom contype="0" conaffinity="0" group="2" mass="0"/>',
        "    </default>",
        '    <default class="room_collider">',
        '      <geom group="3" mass="0" friction="0.8 0.005 0.0001" rgba="0.3 0.6 0.9 0.3"/>',
        "    </default>",
        "  </default>",
        "  <asset>",
        '    <texture name="sky" type="skybox" builtin="gradient" rgb1="0.62 0.78 0.98" rgb2="0.97 0.98 1" width="128" height="768"/>',
    ]
    for t in used:
        space = "linear" if t.endswith(("_normal", "_roughness")) else "sRGB"
        channels = ' nchannel="1"' if t.endswith("_roughness") else ""
        x.append(
            f'    <texture name="{t}" type="2d" file="{t}.png" colorspace="{space}"{channels}/>'
        )
    for name, m in MATERIALS.items():
        x += material_xml(name, m)
    x += [f'    <mesh name="{m}" file="{m}.obj" inertia="shell"/>' for m in meshes]
    x += [
        "  </asset>",
        "  <worldbody>",
        f'    <light name="sun" type="directional" pos="-2.5 -6 5" dir="{numbers(SUN["dir"])}" diffuse="{numbers(SUN["rgb"])}" '
        f'intensity="{SUN["lux"]}" bulbradius="0.01" castshadow="true"/>',
        f'    <light name="sky" type="image" texture="sky" intensity="{SKY_LUMINANCE}"/>',
        '    <geom class="room_collider" name="floor_plane" type="plane" size="3.2 2.6 0.1" friction="1 0.005 0.0001"/>',
    ]
    for piece in all_pieces:
        x += body_xml(piece, assets)
    return "\n".join(x + ["  </worldbody>", "</mujoco>"]) + "\n"


def main():
    here = pathlib.Path(__file__).resolve().parent
    for folder in (here / "meshes", here / "textures"):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
    textures.make_all(here / "textures")
    all_pieces = pieces()
    assets, meshes = write_meshes(all_pieces, here / "meshes")
    (here / "room.xml").write_text(scene_xml(all_pieces, assets, meshes))
    triangles = sum(len(v.mesh.f) for p in all_pieces for v in p.visuals if v.mesh is not None)
    size = sum(f.stat().st_size for f in here.rglob("*") if f.suffix in (".obj", ".png", ".xml"))
    sys.stderr.write(f"{len(all_pieces)} pieces, {triangles} triangles, {size / 1e6:.1f} MB\n")


if __name__ == "__main__":
    main()
