"""Lamps of [[light]] that have an area."""
import math

from description import about
from scenes.lights import octahedron, stage
from scenes.registry import scene


@scene("rectangular lamps, aslant and from behind")
def rect_lamp(k):
    s = stage(spp=80, reference_spp=128)
    s.lamp("rect", "flux", 3000 * k("panel"), color=(1, 0.8, 0.6), position=(-1.6, -0.6, 2.2), orientation=about((0.3, 1, 0.2), -35), size=(1.2, 0.5))
    s.lamp("rect", "luminance", 400 * k("away"), color=(0.5, 0.8, 1), position=(0.1, -0.9, 0.9), orientation=about((1, 0, 0), 100), size=(0.4, 0.6))
    return s


@scene("a disk and a ball that shine")
def round_lamp(k):
    s = stage(spp=64, reference_spp=256)
    s.lamp("disk", "intensity", 150 * k("disk"), color=(1, 0.9, 0.8), position=(0.9, -1.2, 2.0), orientation=about((1, 0.5, 0), 25), size=(0.4,))
    s.lamp("sphere", "flux", 1500 * k("ball"), color=(0.6, 0.7, 1), position=(0.1, -0.8, 0.6), size=(0.2,))
    return s


@scene("a lamp by a mesh, closed and open")
def mesh_light(k):
    s = stage(spp=128, reference_spp=256)
    s.lamp("mesh", "luminance", 600 * k("crystal"), color=(1, 0.7, 0.5), position=(0.1, -0.8, 1.2), orientation=about((1, 2, 3), 40),
           corners=octahedron((0, 0, 0), 0.3))
    s.lamp("mesh", "flux", 900 * k("roof"), color=(0.7, 0.9, 1), position=(-1.3, -0.5, 2.0), orientation=about((0, 0, 1), 30), corners=roof(0.5, 0.2))
    return s


def roof(reach, rise):
    """Four triangles that face down and outwards."""
    rim = [(reach * math.cos(a), reach * math.sin(a), 0.0) for a in (0, math.pi / 2, math.pi, 1.5 * math.pi)]
    corners = []
    for a, b in zip(rim, rim[1:] + rim[:1]):
        corners += [((0.0, 0.0, -rise), (0, 0, -1), (0.0, 0.0)), (b, (0, 0, -1), (0.0, 0.0)), (a, (0, 0, -1), (0.0, 0.0))]
    return corners
