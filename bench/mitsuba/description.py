"""A scene said once, for both programs: gloam_form.py and mitsuba_form.py write it down for each.

Lengths are metres, Z is up, colours linear Rec. 709, light in cd/m², cd and lx (docs/light.md).

A scene is a function of `k`, which it asks for the scale of each lobe and light by name: one, unless a mutation scales
that one. A scale of something that is an input (a colour, an intensity) goes into both programs; one of a lobe alone,
which no input of a material can scale, goes into `lobes` of the material, and so into Mitsuba's picture only.
"""
import math
from dataclasses import dataclass, field

SIZE = (96, 72)  # pixels of every picture
BLOCK = 8


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


class Scene:
    def __init__(self, eye, target, fovy=40.0, max_depth=16, spp=32, reference_spp=32):
        self.eye, self.target, self.fovy, self.max_depth = eye, target, fovy, max_depth
        self.spp, self.reference_spp = spp, reference_spp  # per batch
        self.materials, self.shapes, self.lights = [], [], []
        self.sky_bytes = None       # display colour of the sky, 8 bits a channel
        self.sky_scale = 1.0        # in Mitsuba alone
        self.headlight = None       # MJCF's diffuse

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


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def normalize(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)
