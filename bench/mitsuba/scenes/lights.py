"""Each kind of light."""
import math

from description import Scene, scaled
from scenes.registry import scene


def stage(**more):
    """Matt things in the dark."""
    s = Scene(eye=(0, -4.2, 2.4), target=(0, 0.1, 0.6), fovy=40, max_depth=10, **more)
    s.box(s.material("floor", color=(0.6, 0.6, 0.6), native="diffuse"), (0, 0, -0.05), (6, 6, 0.05))
    s.box(s.material("wall", color=(0.5, 0.45, 0.4), native="diffuse"), (0, 1.6, 1.5), (6, 0.05, 1.5))
    s.sphere(s.material("ball", color=(0.7, 0.3, 0.2), native="diffuse"), (-0.8, 0, 0.5), 0.5)
    s.box(s.material("box", color=(0.2, 0.4, 0.6), native="diffuse"), (0.8, 0.2, 0.45), (0.35, 0.35, 0.45), turn=0.6)
    return s


@scene("two point lamps, one without an intensity of its own")
def point(k):
    s = stage()
    s.light("point", scaled((60, 50, 40), k("lamp")), position=(1.2, -1.5, 2.2))
    s.light("point", scaled((300, 400, 500), k("legacy")), position=(-2.0, -1.0, 2.0), legacy=True)
    return s


@scene("spots, hard and soft")
def spot(k):
    s = stage(reference_spp=160)
    s.light("spot", scaled((400, 360, 300), k("hard")), position=(-1.5, -2, 3), direction=(0.5, 1.1, -1.6), cutoff=0.45, softness=0.0)
    s.light("spot", scaled((200, 260, 320), k("soft")), position=(1.5, -2, 3), direction=(-0.3, 1, -1.2), cutoff=0.8, softness=0.7)
    return s


@scene("directional light without extent, two of them")
def directional(k):
    s = stage()
    s.light("directional", scaled((300, 280, 240), k("sun")), direction=(0.5, 1, -1.2))
    s.light("directional", scaled((60, 80, 120), k("legacy")), direction=(-1, 0.5, -0.8), legacy=True)
    return s


@scene("a sun with an angular radius, and an even sky")
def sun(k):
    s = stage()
    s.sky(k, 90, 110, 140)
    s.light("directional", scaled((300, 280, 240), k("sun")), direction=(0.6, 1, -1.1), radius=0.1)
    return s


@scene("luminous spheres: a lamp's bulb and an emitting ball")
def sphere_lamp(k):
    s = stage(spp=96, reference_spp=64)
    s.light("point", scaled((80, 70, 60), k("bulb")), position=(1.6, -1.8, 2.0), radius=0.3)
    s.sphere(s.material("globe", color=(0.6, 0.8, 0.9), emission=300 * k("globe"), native="diffuse"), (0.1, -0.9, 0.7), 0.25)
    return s


@scene("an emitting mesh")
def mesh_lamp(k):
    s = stage(spp=64, reference_spp=96)
    glow = s.material("glow", color=(0.9, 0.8, 0.6), emission=700 * k("glow"), native="diffuse")
    s.mesh(glow, octahedron((0, -0.7, 1.5), 0.35))
    return s


def octahedron(center, reach):
    tips = [tuple(c + s * reach * (i == j) for j, c in enumerate(center)) for i in range(3) for s in (1, -1)]
    corners = []
    for x in (0, 1):
        for y in (2, 3):
            for z in (4, 5):
                face = [tips[x], tips[y], tips[z]]
                signs = [1 - 2 * (tip % 2) for tip in (x, y, z)]
                if signs[0] * signs[1] * signs[2] < 0:
                    face.reverse()
                corners += [(tip, tuple(sign / math.sqrt(3) for sign in signs), (0.0, 0.0)) for tip in face]
    return corners


@scene("twenty lamps of different power")
def many_lamps(k):
    s = stage()
    for i in range(20):
        angle = 2.4 * i
        color = (1 + math.sin(angle), 1 + math.sin(angle + 2), 1 + math.sin(angle + 4))
        s.light("point", scaled(color, (2 + i) * k("lamps")), position=(2.5 * math.cos(angle), -1.3 + 1.2 * math.sin(angle), 1.5 + 0.07 * i))
    return s


@scene("the headlight alone")
def headlight(k):
    s = Scene(eye=(0, -3, 1), target=(0, 0, 0.5), fovy=40, max_depth=2)
    s.headlight = scaled((0.6, 0.5, 0.4), k("headlight"))
    s.sphere(s.material("ball", color=(0.7, 0.7, 0.7), native="diffuse"), (0, 0, 0.5), 0.7)
    return s
