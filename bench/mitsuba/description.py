"""A scene said once, for both programs: gloam_form.py and mitsuba_form.py write it down for each.

Lengths are metres, Z is up, colours linear Rec. 709, light in cd/m², cd and lx (docs/light.md).

A scene is a function of `k`, which it asks for the scale of each lobe and light by name: one, unless a mutation scales
that one. A scale of something that is an input (a colour, an intensity) goes into both programs; one of a lobe alone,
which no input of a material can scale, goes into `lobes` of the material, and so into Mitsuba's picture only.
"""
import math
from dataclasses import dataclass, field

SIZE = (96, 72)  # pixels of every picture that is compared
BLOCK = 8
FILTER_SIGMA, FILTER_CUT = 0.42, 1.25  # [px] of the pixel's filter, as in src/render/kernel/camera/camera.h


@dataclass
class Material:
    """Names of MJCF and of [[material]] (docs/materials.md)."""
    name: str
    color: tuple = (0.5, 0.5, 0.5)
    metallic: float = 0.0
    roughness: float = 0.5
    specular: float = 0.0           # MJCF's: 0.5 = a whole dielectric layer, 0 = none
    opacity: float = 1.0
    emission: float = 0.0           # luminance [cd/m²] per colour
    layers: dict = field(default_factory=dict)   # keys of [[material]]
    maps: dict = field(default_factory=dict)     # role of MJCF's layers -> rows of 8-bit texels
    native: str = ""                # Mitsuba's own plug-in for it; "" = the published lobe in lobe.py
    lobes: dict = field(default_factory=dict)    # scales of lobes, in Mitsuba alone


@dataclass
class Shape:
    kind: str                       # box, sphere, mesh
    material: Material
    position: tuple = (0, 0, 0)
    size: tuple = ()                # box: half edges; sphere: radius
    turn: float = 0.0               # about z [rad]
    corners: list = field(default_factory=list)  # mesh: triangles of three (position, normal, uv)


@dataclass
class Light:
    kind: str                       # point, spot, directional
    intensity: tuple                # [cd], directional: [lx], per channel
    position: tuple = (0, 0, 0)
    direction: tuple = (0, 0, -1)
    radius: float = 0.0             # [m], directional: sine of the half angle
    cutoff: float = 0.0             # spot: half angle [rad]
    softness: float = 0.0           # spot: outer share of it over which it fades
    legacy: bool = False            # without an intensity, as most MJCF lights: diffuse alone


@dataclass
class Lamp:
    """A [[light]] of the scene file (docs/light.md). It shines along its own -Z."""
    kind: str                       # rect, disk, sphere, mesh; profile: a point with a photometric file
    unit: str                       # of `strength`: luminance, intensity, flux; profile: multiplier of the file
    strength: float
    color: tuple = (1, 1, 1)        # the hue alone counts
    position: tuple = (0, 0, 0)
    orientation: tuple = (1, 0, 0, 0)            # w, x, y, z
    size: tuple = ()                # rect: edges along its x and y; disk, sphere: radius
    corners: list = field(default_factory=list)  # mesh: as of Shape, in the lamp's frame
    profile: list = field(default_factory=list)  # [cd] rows of even horizontal angles from +X once around, each of even
    #                                              vertical ones, 0 to 90 degrees from -Z; nothing beyond

    def area(self):
        if self.kind == "rect":
            return self.size[0] * self.size[1]
        if self.kind == "mesh":
            return sum(triangle_area(*(c[0] for c in self.corners[i:i + 3])) for i in range(0, len(self.corners), 3))
        return math.pi * self.size[0] ** 2 * (4 if self.kind == "sphere" else 1)

    def radiance(self):
        """Per channel: area lamps obey Lambert's law."""
        across = math.pi * self.size[0] ** 2 if self.kind == "sphere" else self.area()  # as seen from the front
        per = {"luminance": 1, "intensity": across, "flux": math.pi * self.area()}[self.unit]
        return scaled(self.hue(), self.strength / per)

    def hue(self):
        return scaled(self.color, 1 / luminance(self.color))


@dataclass
class Volume:
    """A [[volume]]: a box of a medium (docs/media.md)."""
    position: tuple
    size: tuple                     # edges
    extinction: tuple               # [1/m] per channel, of a value of one
    albedo: tuple = (0, 0, 0)
    g: float = 0.0
    orientation: tuple = (1, 0, 0, 0)
    grid: list = field(default_factory=list)     # [z][y][x] of values, at the centres of voxels
    temperature: float = 0.0        # [K]
    emission: float = 0.0           # 1 = Kirchhoff's law; has no counterpart in Mitsuba


@dataclass
class EvenSky:
    """[sky] with a luminance."""
    luminance: float
    color: tuple

    def radiance(self, _):
        return scaled(self.color, self.luminance / luminance(self.color))


@dataclass
class SkyMap:
    """[sky] with a picture: a gradient from nadir to zenith and soft patches of light, by illuminance of level ground [lx]."""
    illuminance: float
    zenith: tuple
    nadir: tuple
    patches: list = field(default_factory=list)  # (unit direction, sharpness, colour)
    turn: float = 0.0               # counter-clockwise from above [deg]

    def value(self, d_E):
        """Of the picture, in its own frame."""
        up = 0.5 + 0.5 * d_E[2]
        out = [n + up * (z - n) for z, n in zip(self.zenith, self.nadir)]
        for axis, sharpness, color in self.patches:
            weight = math.exp(sharpness * (sum(a * b for a, b in zip(axis, d_E)) - 1))
            out = [o + weight * c for o, c in zip(out, color)]
        return out

    def scale(self):
        """[cd/m²] of a value of one."""
        rows, total = 256, 0.0
        for i in range(rows):
            z = (i + 0.5) / rows  # equal steps of z are equal areas
            for j in range(2 * rows):
                a, r = math.pi * (j + 0.5) / rows, math.sqrt(1 - z * z)
                total += z * luminance(self.value((r * math.cos(a), r * math.sin(a), z)))
        return self.illuminance / (2 * math.pi * total / (2 * rows * rows))


class Scene:
    def __init__(self, eye, target, fovy=40.0, max_depth=16, spp=32, reference_spp=32, size=SIZE):
        self.eye, self.target, self.fovy, self.max_depth = eye, target, fovy, max_depth
        self.spp, self.reference_spp = spp, reference_spp  # per batch
        self.size = size            # [px]
        self.materials, self.shapes, self.lights = [], [], []
        self.sky_bytes = None       # display colour of the sky, 8 bits a channel
        self.sky_scale = 1.0        # in Mitsuba alone
        self.headlight = None       # MJCF's diffuse
        self.lamps, self.volumes, self.environment = [], [], None  # what the scene file has: Lamp, Volume, EvenSky or SkyMap

    def material(self, name, **what):
        self.materials.append(Material(name, **what))
        return self.materials[-1]

    def box(self, material, position, half, turn=0.0):
        self.shapes.append(Shape("box", material, position, half, turn))

    def sphere(self, material, position, radius):
        self.shapes.append(Shape("sphere", material, position, (radius,)))

    def mesh(self, material, corners):
        self.shapes.append(Shape("mesh", material, corners=corners))

    def light(self, kind, intensity, **what):
        self.lights.append(Light(kind, intensity, **what))

    def lamp(self, kind, unit, strength, **what):
        self.lamps.append(Lamp(kind, unit, strength, **what))

    def volume(self, **what):
        self.volumes.append(Volume(**what))

    def sky(self, k, *display):
        """Even light from all around; MJCF has it as 8-bit display colours, of which 255 is 100 cd/m²."""
        self.sky_bytes, self.sky_scale = display, k.lobe("sky")["sky"]

    @property
    def sky_radiance(self):
        return tuple(100 * linear(byte / 255) for byte in self.sky_bytes or (0, 0, 0))


class Scales:
    """What a scene asks for the scale of each of its lobes and lights. Remembers the names."""

    def __init__(self, scaled="", factor=0.97):
        self.scaled, self.factor, self.inputs, self.lobes = scaled, factor, [], []

    def __call__(self, name):
        """Of an input."""
        if name not in self.inputs:
            self.inputs.append(name)
        return self.factor if name == self.scaled else 1.0

    def lobe(self, name):
        """Of a lobe, in Mitsuba alone."""
        if name not in self.lobes:
            self.lobes.append(name)
        return {name: self.factor if name == self.scaled else 1.0}


def scaled(color, factor):
    return tuple(c * factor for c in color)


def linear(display):
    """IEC 61966-2-1."""
    return display / 12.92 if display <= 0.04045 else ((display + 0.055) / 1.055) ** 2.4


def display(value):
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


def luminance(color):
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]


def triangle_area(a, b, c):
    (ax, ay, az), (bx, by, bz) = subtract(b, a), subtract(c, a)
    return 0.5 * math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)


def about(axis, degrees):
    """Quaternion (w, x, y, z) of a turn."""
    half = math.radians(degrees) / 2
    return (math.cos(half), *scaled(normalize(axis), math.sin(half)))


def rotation(q):
    """Rows of the matrix of a unit quaternion (w, x, y, z)."""
    w, x, y, z = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def normalize(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)
