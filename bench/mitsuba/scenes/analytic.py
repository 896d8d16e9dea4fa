"""Scenes with a closed form: both programs are held against it."""
import math

from description import Scene, about, rotation, scaled
from scenes import closed_form
from scenes.closed_form import floor_point, polygon_irradiance, sheet_reflects
from scenes.glass import quad
from scenes.registry import scene


@scene("white furnace: no white thing differs from the even sky", exact=lambda s: closed_form.even(s, s.sky_radiance))
def furnace(k):
    s = Scene(eye=(0, -5, 1.6), target=(0, 0, 0), fovy=30, max_depth=64)
    s.sky(k, 188, 188, 188)
    white = {"color": (1, 1, 1)}
    materials = [s.material("matt", native="diffuse", **white),
                 s.material("mirror", metallic=1.0, roughness=0.0, native="mirror", **white),
                 s.material("metal", metallic=1.0, roughness=0.6, **white),
                 s.material("plastic", roughness=0.4, specular=0.5, **white),
                 s.material("coated", roughness=0.5, specular=0.5, layers={"coat_weight": 1, "coat_roughness": 0.3}, **white),
                 s.material("glass", roughness=0.0, native="glass", layers={"transmission_weight": 1}, **white),
                 s.material("ice", roughness=0.5, layers={"transmission_weight": 1}, **white),
                 s.material("fuzzy", layers={"fuzz_weight": 1}, **white)]
    for i, material in enumerate(materials):
        s.sphere(material, (-1.35 + 0.9 * (i % 4), 0, 0.5 - 1.0 * (i // 4)), 0.4)
    return s


def room_radiance(s):
    color, emission = s.materials[0].color, s.materials[0].emission
    return closed_form.even(s, tuple(emission * c / (1 - c) for c in color))


@scene("closed room of walls that shine: emission / (1 - albedo)", exact=room_radiance)
def closed_room(k):
    s = Scene(eye=(0.3, -0.5, 0.1), target=(0, 1, -0.2), fovy=70, max_depth=64)
    wall = s.material("wall", color=scaled((0.5, 0.3, 0.7), k("albedo")), emission=50 * k("emission"), native="diffuse")
    for axis in range(3):
        for side in (1, -1):
            position, half = [0, 0, 0], [1.2, 1.2, 1.2]
            position[axis], half[axis] = 1.1 * side, 0.1
            s.box(wall, tuple(position), tuple(half))
    return s


def plane(k, **more):
    s = Scene(eye=(0, -1.2, 2.5), target=(0, 0.1, 0), fovy=50, max_depth=2, **more)
    s.box(s.material("floor", color=(0.6, 0.5, 0.4), native="diffuse"), (0, 0, -0.05), (9, 9, 0.05))
    return s


def lamps_radiance(s):
    def radiance(eye, direction):
        p = floor_point(eye, direction)
        total = [0.0, 0.0, 0.0]
        for light in s.lights:
            if light.kind == "directional":
                share = -light.direction[2] / math.sqrt(sum(x * x for x in light.direction))
            else:  # a luminous sphere as well: its irradiance is that of a point at its centre
                to = [a - b for a, b in zip(light.position, p)]
                square = sum(x * x for x in to)
                share = to[2] / square**1.5
                if light.kind == "spot":
                    axis = closed_form.normalize(light.direction)
                    angle = math.acos(-sum(a * b for a, b in zip(axis, to)) / math.sqrt(square))
                    x = min(max((light.cutoff - angle) / (light.cutoff * light.softness), 0), 1)
                    share *= x * x * (3 - 2 * x)
            total = [t + share * c for t, c in zip(total, light.intensity)]
        return [t * c / math.pi for t, c in zip(total, s.materials[0].color)]
    return closed_form.blocks(s, radiance)


@scene("lamps of all kinds over a plane: the inverse square and the cosine", exact=lamps_radiance)
def lamps_on_plane(k):
    s = plane(k)
    s.light("point", scaled((40, 30, 20), k("point")), position=(-1.2, 0.4, 1.2))
    s.light("point", scaled((150, 300, 220), k("bulb")), position=(3.4, 0.3, 1.1), radius=0.4)
    s.light("spot", scaled((60, 80, 100), k("spot")), position=(0.2, 1.5, 2.5), direction=(-0.1, -0.6, -1), cutoff=0.7, softness=0.5)
    s.light("directional", scaled((20, 20, 30), k("sun")), direction=(0.5, 0.4, -1))
    s.light("directional", scaled((30, 20, 20), k("wide_sun")), direction=(-0.8, 0.1, -1), radius=0.15)
    return s


def profile_radiance(s):
    def candela(lamp, d):
        x, y, z = (closed_form.dot(axis, d) for axis in zip(*rotation(lamp.orientation)))
        around, down = len(lamp.profile), len(lamp.profile[0])
        v = math.acos(max(-1.0, min(1.0, -z))) * 2 / math.pi * (down - 1)
        h = math.atan2(y, x) % (2 * math.pi) / (2 * math.pi) * around
        if v >= down - 1:
            return 0.0
        i, j = int(v), int(h) % around
        rows = [row[i] + (v - i) * (row[i + 1] - row[i]) for row in (lamp.profile[j], lamp.profile[(j + 1) % around])]
        return (rows[0] + (h - int(h)) * (rows[1] - rows[0])) * lamp.strength

    def radiance(eye, direction):
        p = floor_point(eye, direction)
        total = [0.0, 0.0, 0.0]
        for lamp in s.lamps:
            to = [a - b for a, b in zip(lamp.position, p)]
            square = closed_form.dot(to, to)
            share = candela(lamp, [-t / math.sqrt(square) for t in to]) * to[2] / square**1.5
            total = [t + share * c for t, c in zip(total, lamp.hue())]
        return [t * c / math.pi for t, c in zip(total, s.materials[0].color)]
    return closed_form.blocks(s, radiance)


@scene("lamps with photometric files over a plane: the inverse square of their candela", exact=profile_radiance)
def profile_on_plane(k):
    s = plane(k)
    steps = range(19)  # of 5 degrees, from straight down to the side; fine enough for the pixel's filter not to matter
    wings = [[(40 + 60 * math.sin(0.12 * i + math.pi * j / 18) ** 2) * math.cos(math.pi * i / 36) ** 2 for i in steps] for j in range(36)]
    cone = [[100 * math.cos(math.pi * i / 36) ** 4 for i in steps]]  # the same all around
    s.lamp("profile", "times", 1.5 * k("wings"), color=(1.0, 0.8, 0.5), position=(-0.8, 0.2, 1.4), orientation=about((0.2, 1, 0.4), 25), profile=wings)
    s.lamp("profile", "times", 2.0 * k("cone"), color=(0.5, 0.7, 1.0), position=(1.0, 0.6, 1.5), orientation=about((1, 0, 0), -20), profile=cone)
    return s


def panel_radiance(s):
    box = s.shapes[1]
    (x, y, z), (a, b, c) = box.position, box.size
    emitted = scaled(box.material.color, box.material.emission)
    low = z - c
    faces = [[(x - a, y - b, low), (x + a, y - b, low), (x + a, y + b, low), (x - a, y + b, low)]]
    sides = [((x + a, y - b), (x + a, y + b), (1, 0)), ((x - a, y + b), (x - a, y - b), (-1, 0)),
             ((x + a, y + b), (x - a, y + b), (0, 1)), ((x - a, y - b), (x + a, y - b), (0, -1))]

    def radiance(eye, direction):
        p = floor_point(eye, direction)
        share = polygon_irradiance(faces[0], p)
        for (x0, y0), (x1, y1), n in sides:
            if (p[0] - x0) * n[0] + (p[1] - y0) * n[1] > 0:
                share += polygon_irradiance([(x0, y0, low), (x1, y1, low), (x1, y1, z + c), (x0, y0, z + c)], p)
        return [share * e * f / math.pi for e, f in zip(emitted, s.materials[0].color)]
    return closed_form.blocks(s, radiance)


@scene("an emitting box over a plane: Lambert's formula for polygons", exact=panel_radiance)
def panel_on_plane(k):
    s = plane(k, reference_spp=64)
    glow = s.material("glow", color=(0.9, 0.8, 0.7), emission=120 * k("panel"), native="diffuse")
    s.box(glow, (0.2, 3.6, 1.2), (1.0, 0.6, 0.2))
    return s


def pane_radiance(s):
    layers = s.materials[0].layers

    def radiance(eye, direction):
        reflects = sheet_reflects(abs(direction[1]), layers["ior"])
        return [sky * (reflects + tint * (1 - reflects)) for sky, tint in zip(s.sky_radiance, layers["transmission_color"])]
    return closed_form.blocks(s, radiance)


@scene("the even sky in and through a tinted pane: Fresnel's formulas", exact=pane_radiance)
def pane_in_sky(k):
    s = Scene(eye=(0.0, -1.0, 0), target=(0.6, 0, 0.1), fovy=70, max_depth=4)
    s.sky(k, 200, 180, 160)
    pane = s.material("pane", color=(1, 1, 1), roughness=0.0, native="pane", lobes=k.lobe("reflection"),
                      layers={"transmission_weight": 1, "thin_walled": True, "ior": 1.6, "transmission_color": scaled((0.9, 0.5, 0.2), k("tint"))})
    s.mesh(pane, quad((-50, 0, -50), (100, 0, 0), (0, 0, 100)))
    return s
