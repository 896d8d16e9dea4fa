"""Lobes of opaque surfaces."""
import math

from description import Scales, Scene, scaled
from scenes.registry import scene


def on_floor(k=Scales(), floor=(0.3, 0.3, 0.3), **more):
    """A matt floor under an even sky and a panel from above: what most lobes are judged in. With `k` its lights can be scaled."""
    s = Scene(eye=(0, -4.2, 2.2), target=(0, 0, 0.55), fovy=38, max_depth=8, **more)
    s.sky(k, 150, 170, 190)
    s.box(s.material("floor", color=floor, native="diffuse"), (0, 0, -0.05), (4, 4, 0.05))
    panel = s.material("panel", color=(0.8, 0.8, 0.8), emission=400 * k("panel"), native="diffuse")
    s.box(panel, (0.8, -0.6, 3.2), (0.7, 0.5, 0.02))
    return s


def trio(s, materials):
    """Two balls and a box of up to three materials."""
    s.sphere(materials[0], (-0.95, 0, 0.56), 0.55)
    s.sphere(materials[-1], (0.95, 0.1, 0.56), 0.55)
    s.box(materials[len(materials) // 2], (0, 0.5, 0.42), (0.3, 0.3, 0.4), turn=0.5)  # glass must not share a face with the floor


@scene("matt walls, inter-reflection, an emitting box")
def diffuse(k):
    s = Scene(eye=(0, -3.3, 1), target=(0, 0, 1), fovy=36, max_depth=8, reference_spp=64)
    white = s.material("white", color=scaled((0.7, 0.7, 0.7), k("white")), native="diffuse")
    red = s.material("red", color=scaled((0.6, 0.1, 0.08), k("red")), native="diffuse")
    green = s.material("green", color=scaled((0.12, 0.5, 0.15), k("green")), native="diffuse")
    lamp = s.material("lamp", color=(0.8, 0.7, 0.5), emission=300 * k("lamp"), native="diffuse")
    s.box(white, (0, 0, -0.05), (1.1, 1.1, 0.05))
    s.box(white, (0, 0, 2.05), (1.1, 1.1, 0.05))
    s.box(white, (0, 1.05, 1), (1.1, 0.05, 1))
    s.box(red, (-1.05, 0, 1), (0.05, 1.1, 1))
    s.box(green, (1.05, 0, 1), (0.05, 1.1, 1))
    s.box(lamp, (0, 0, 1.99), (0.7, 0.7, 0.02))  # let into the ceiling
    s.box(white, (-0.4, 0.3, 0.55), (0.28, 0.28, 0.55), turn=0.3)
    s.sphere(white, (0.45, -0.2, 0.35), 0.35)
    return s


@scene("rough metals")
def metal(k):
    s = on_floor(k)
    colors = [(0.9, 0.6, 0.3), (0.55, 0.56, 0.6), (0.9, 0.3, 0.25)]
    trio(s, [s.material(f"metal{i}", color=color, metallic=1.0, roughness=rough, lobes=k.lobe("metal"))
             for i, (color, rough) in enumerate(zip(colors, (0.2, 0.45, 0.8)))])
    return s


@scene("mirrors")
def mirror(k):
    s = on_floor(floor=(0.35, 0.2, 0.12))
    trio(s, [s.material("mirror", color=(1, 1, 1), metallic=1.0, roughness=0.0, native="mirror", lobes=k.lobe("metal"))])
    return s


@scene("rough dielectric layers over matt colour")
def dielectric(k):
    s = on_floor()
    trio(s, [s.material(f"plastic{i}", color=scaled(color, k("base")), roughness=rough, specular=0.5, lobes=k.lobe("layer"),
                        layers={"ior": ior})
             for i, (color, rough, ior) in enumerate([((0.02, 0.02, 0.025), 0.15, 1.5), ((0.1, 0.02, 0.02), 0.35, 2.0),
                                                      ((0.05, 0.2, 0.4), 0.6, 1.5)])])
    return s


@scene("clear and coloured coats")
def coat(k):
    s = on_floor(spp=64)
    trio(s, [s.material("lacquer", color=(0.3, 0.03, 0.03), roughness=0.5, specular=0.5, lobes=k.lobe("coat"),
                        layers={"coat_weight": 1, "coat_roughness": 0.1}),
             s.material("black", color=(0, 0, 0), lobes=k.lobe("coat"),
                        layers={"coat_weight": 1, "coat_roughness": 0.3, "coat_ior": 1.8}),
             s.material("candy", color=(0.8, 0.8, 0.8), metallic=1.0, roughness=0.35, lobes=k.lobe("coat"),
                        layers={"coat_weight": 0.7, "coat_roughness": 0.2, "coat_color": scaled((0.3, 0.5, 0.9), k("coat_color"))})])
    return s


@scene("fuzz over dark and coloured cloth")
def fuzz(k):
    s = on_floor()
    trio(s, [s.material(f"velvet{i}", color=color, lobes=k.lobe("fuzz"),
                        layers={"fuzz_weight": weight, "fuzz_roughness": rough, "fuzz_color": scaled(tint, k("fuzz_color"))})
             for i, (color, weight, rough, tint) in enumerate([((0, 0, 0), 1.0, 0.5, (0.8, 0.6, 0.9)),
                                                               ((0.1, 0.02, 0.05), 0.8, 0.3, (0.9, 0.9, 0.9)),
                                                               ((0.02, 0.1, 0.05), 0.6, 0.9, (0.5, 0.8, 0.6))])])
    return s


def tin(center, radius, half, steps=48):
    """Triangles of an upright closed cylinder, smooth around; u runs around the side and along x on the lid, v up and along y."""
    def side(i, up):
        angle = 0.1 + 2 * math.pi * i / steps
        normal = (math.cos(angle), math.sin(angle), 0)
        at = tuple(c + radius * n for c, n in zip(center, normal))
        return (at[0], at[1], center[2] + (half if up else -half)), normal, (i / steps, float(up))

    def lid(at):
        return at, (0, 0, 1), (at[0] - center[0], at[1] - center[1])

    corners = []
    for i in range(steps):
        a, b, c, d = side(i, False), side(i + 1, False), side(i + 1, True), side(i, True)
        corners += [a, b, c, a, c, d, lid((center[0], center[1], center[2] + half)), lid(d[0]), lid(c[0])]
    return corners


@scene("brushed metal and lacquer: highlights drawn out along the texture's u")
def anisotropy(k):
    s = on_floor()
    for i, (x, rough, layers) in enumerate([(-1.1, 0.4, {"anisotropy": 0.8}), (0, 0.5, {"anisotropy": 0.6, "anisotropy_rotation": 0.125}),
                                            (1.1, 0.3, {"anisotropy": 0.9, "anisotropy_rotation": 0.25})]):
        brushed = s.material(f"brushed{i}", color=(0.8, 0.75, 0.7), metallic=1.0, roughness=rough, layers=layers, lobes=k.lobe("metal"))
        s.mesh(brushed, tin((x, 0, 0.7), 0.45, 0.7))
    return s
