"""[[volume]]: light in media."""
import math

from description import EvenSky, Scene, about, rotation, scaled
from scenes import closed_form
from scenes.lights import stage
from scenes.registry import scene


@scene("even fog that scatters to all sides, a ball that shines within")
def fog(k):
    s = stage(spp=72, reference_spp=104)
    s.max_depth = 6
    s.lamp("sphere", "intensity", 60 * k("lamp"), color=(1, 0.9, 0.7), position=(0.5, -0.8, 1.5), size=(0.35,))
    s.volume(position=(0, -0.2, 1.0), size=(3.6, 2.4, 1.9), extinction=scaled((0.5, 0.5, 0.5), k("extinction")), albedo=(0.9, 0.7, 0.4))
    return s


@scene("coloured fogs that scatter forwards and back, aslant")
def coloured_fog(k):
    s = stage(reference_spp=96)
    s.max_depth = 6
    s.sky(k, 60, 70, 90)
    s.light("point", scaled((300, 300, 300), k("lamp")), position=(1.2, 1.2, 2.4))
    s.light("directional", (80, 80, 80), direction=(0.5, 0.4, -1))
    s.volume(position=(-0.75, -0.9, 1.0), size=(1.4, 1.0, 1.6), extinction=scaled((1.2, 2.0, 3.2), k("forward")), albedo=(0.95, 0.9, 0.8), g=0.7,
             orientation=about((0.2, 0.3, 1), 30))
    s.volume(position=(0.85, -0.6, 1.0), size=(1.3, 1.1, 1.4), extinction=scaled((3.2, 2.0, 1.2), k("back")), albedo=(0.8, 0.8, 0.95), g=-0.4,
             orientation=about((1, 0.1, 0.4), 20))
    return s


@scene("smoke on a grid of voxels, aslant")
def smoke(k):
    s = stage(reference_spp=96)
    s.max_depth = 6
    s.sky(k, 60, 70, 90)
    s.light("directional", scaled((200, 190, 170), k("sun")), direction=(-0.6, 0.7, -1))
    s.volume(position=(0.05, -0.8, 1.0), size=(1.8, 1.0, 1.6), extinction=scaled((2.5, 2.5, 2.5), k("density")), albedo=(0.8, 0.7, 0.6), g=0.5,
             orientation=about((0.1, 0.2, 1), 25), grid=billow(9, 5, 7))
    return s


def billow(nx, ny, nz):
    """[z][y][x] of 0 to 1, without any symmetry; it does not vanish at the box's walls."""
    return [[[0.5 + 0.5 * math.sin(1.1 * x + 0.7 * y * y - 0.9 * z + 0.3 * x * z) for x in range(nx)] for y in range(ny)] for z in range(nz)]


def planckian(kelvin):
    """Luminance of a black body, linear Rec. 709 [cd/m²]: Planck's law, the CIE 1931 functions as fitted by Wyman, Sloan and Shirley 2013."""
    def bell(nm, center, left, right):
        return math.exp(-0.5 * ((nm - center) / (left if nm < center else right)) ** 2)

    h, c, boltzmann = 6.62607015e-34, 299792458.0, 1.380649e-23
    xyz = [0.0, 0.0, 0.0]
    for nm in range(360, 831):
        m = nm * 1e-9
        power = 2 * h * c * c / m**5 / math.expm1(h * c / (m * boltzmann * kelvin)) * 1e-9 * 683.002
        match = (1.056 * bell(nm, 599.8, 37.9, 31.0) + 0.362 * bell(nm, 442.0, 16.0, 26.7) - 0.065 * bell(nm, 501.1, 20.4, 26.2),
                 0.821 * bell(nm, 568.8, 46.9, 40.5) + 0.286 * bell(nm, 530.9, 16.3, 31.1),
                 1.217 * bell(nm, 437.0, 11.8, 36.0) + 0.681 * bell(nm, 459.0, 26.0, 13.8))
        xyz = [a + power * b for a, b in zip(xyz, match)]
    x, y, z = xyz
    return (3.2406255 * x - 1.5372080 * y - 0.4986286 * z, -0.9689307 * x + 1.8757561 * y + 0.0415175 * z,
            0.0557101 * x - 0.2040211 * y + 1.0569959 * z)


def chord(volume, eye, direction):
    """Length of a ray in the box."""
    axes = list(zip(*rotation(volume.orientation)))
    near, far = 0.0, math.inf
    for axis, edge in zip(axes, volume.size):
        o = closed_form.dot(axis, [e - p for e, p in zip(eye, volume.position)])
        d = closed_form.dot(axis, direction)
        a, b = sorted(((-edge / 2 - o) / d, (edge / 2 - o) / d))
        near, far = max(near, a), min(far, b)
    return max(far - near, 0.0)


def glow_radiance(s):
    volume, sky = s.volumes[0], s.environment.radiance(None)
    body = scaled(planckian(volume.temperature), volume.emission)

    def radiance(eye, direction):
        length = chord(volume, eye, direction)
        passes = [math.exp(-e * length) for e in volume.extinction]
        return [b * (1 - p) + light * p for b, light, p in zip(body, sky, passes)]
    return closed_form.blocks(s, radiance)


@scene("glowing gas that absorbs, before an even sky: Kirchhoff's and Planck's laws", exact=glow_radiance, peer=False)
def glow(k):
    s = Scene(eye=(0.1, -3.0, 0.2), target=(0, 0, 0), fovy=40, max_depth=3, spp=8)
    s.environment = EvenSky(400 * k("sky"), (0.5, 0.7, 1.0))
    s.volume(position=(0, 0, 0), size=(4, 2, 4), extinction=scaled((0.2, 0.5, 1.0), k("extinction")), orientation=about((0.3, 0.1, 1), 20),
             temperature=2200.0, emission=5e-4 * k("emission"))
    return s
