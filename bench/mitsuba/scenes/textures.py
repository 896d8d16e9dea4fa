"""Pictures on surfaces: colour, relief, holes, light."""
from description import Scene, scaled
from scenes.glass import behind, quad
from scenes.registry import scene


def texels(size, color_at):
    return [[tuple(color_at(x, y)) for x in range(size)] for y in range(size)]


def noise(x, y, channel=0):
    """Even 0 … 255, a fixed function of the texel."""
    h = (x * 374761393 + y * 668265263 + channel * 2147483647) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    return (h ^ (h >> 16)) & 255


def board(k, max_depth=8):
    """A wall and a floor that face the viewer well, lit by the sky and a panel."""
    s = Scene(eye=(0, -3.2, 1.3), target=(0, 0, 0.75), fovy=40, max_depth=max_depth)
    s.sky(k, 110, 120, 130)
    s.box(s.material("panel", color=(0.8, 0.8, 0.8), emission=500 * k("panel"), native="diffuse"), (-1.5, -1.5, 2.6), (0.5, 0.5, 0.02))
    return s


def hang(s, wall, floor):
    s.mesh(wall, quad((-1.3, 0.6, 0.0), (2.6, 0, 0), (0, 0, 1.7)))
    s.mesh(floor, quad((-1.3, -1.4, 0.0), (2.6, 0, 0), (0, 2.0, 0)))


@scene("colour by a picture, times a colour")
def colour_map(k):
    s = board(k)
    picture = texels(8, lambda x, y: (255, 32 * y, 40) if x == 0 else tuple(noise(x, y, c) for c in range(3)))
    wall = s.material("wall", color=scaled((0.9, 0.8, 0.7), k("colour")), maps={"rgb": picture}, native="diffuse")
    floor = s.material("floor", color=scaled((0.5, 0.6, 0.9), k("colour")), maps={"rgb": picture}, native="diffuse")
    hang(s, wall, floor)
    return s


@scene("relief by a normal map")
def normal_map(k):
    s = board(k, max_depth=2)  # on scattered light Gloam averages relief that a pixel cannot see, which flattens it: docs/mitsuba.md
    relief = texels(8, lambda x, y: (96 + noise(x, y) // 4, 96 + noise(x, y, 1) // 4, 240))
    color = scaled((0.7, 0.7, 0.65), k("colour"))
    hang(s, *(s.material(name, color=color, maps={"normal": relief}, native="diffuse") for name in ("wall", "floor")))
    return s


@scene("holes by a picture of opacity")
def cut_out(k):
    holes = texels(8, lambda x, y: (noise(x, y) if x + y > 4 else 255,))
    return behind(lambda s: [s.material(f"lace{i}", color=scaled(color, k("lace")), maps={"opacity": holes}, native="diffuse")
                                for i, color in enumerate([(0.8, 0.8, 0.8), (0.8, 0.5, 0.2), (0.1, 0.1, 0.1)])])


@scene("a screen: a picture that shines")
def screen(k):
    s = Scene(eye=(0, -3.2, 1.3), target=(0, 0, 0.7), fovy=42, max_depth=12, spp=96, reference_spp=64)
    s.box(s.material("room", color=(0.6, 0.6, 0.6), native="diffuse"), (0, 0, -0.05), (4, 4, 0.05))
    picture = texels(8, lambda x, y: tuple(40 + noise(x, y, c) * 4 // 5 for c in range(3)))
    shine = s.material("screen", color=(0, 0, 0), emission=300 * k("screen"), maps={"emissive": picture}, native="diffuse")
    s.mesh(shine, quad((-1.2, 0.6, 0.15), (2.4, 0, 0), (0, 0, 1.4)))
    s.box(s.material("back", color=(0, 0, 0), native="diffuse"), (0, 0.631, 0.85), (1.2, 0.03, 0.7))  # Mitsuba's shines forwards alone
    s.sphere(s.material("ball", color=(0.7, 0.7, 0.7), native="diffuse"), (0.3, -0.3, 0.35), 0.35)
    return s
