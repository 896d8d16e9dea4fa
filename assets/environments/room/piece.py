"""What a furniture maker hands over: named visuals and colliders in the piece's own frame."""

from dataclasses import dataclass, field

from mesh import Mesh, join


@dataclass
class Visual:
    name: str
    material: str
    mesh: Mesh | None = None  # its texture coordinates are in metres unless the material says unit
    asset: str = ""  # shared mesh asset; empty = <piece>_<name>
    primitive: str = ""  # MJCF type, instead of a mesh
    size: tuple = ()
    pos: tuple = (0.0, 0.0, 0.0)
    euler: tuple = (0.0, 0.0, 0.0)  # degrees
    rgba: tuple = ()


@dataclass
class Collider:
    type: str
    size: tuple  # MJCF half sizes [m]
    pos: tuple = (0.0, 0.0, 0.0)
    euler: tuple = (0.0, 0.0, 0.0)
    friction: str = ""


@dataclass
class Piece:
    name: str
    pos: tuple = (0.0, 0.0, 0.0)
    yaw: float = 0.0  # degrees
    mass: float = 0.0  # > 0: a free body of that mass [kg], else static
    visuals: list = field(default_factory=list)
    colliders: list = field(default_factory=list)

    def show(self, name, material, *meshes, asset="", rgba=()):
        self.visuals.append(Visual(name, material, join(*meshes), asset, rgba=rgba))
        return self

    def collide_box(self, lo, hi, friction=""):
        half = tuple((b - a) / 2 for a, b in zip(lo, hi))
        mid = tuple((b + a) / 2 for a, b in zip(lo, hi))
        self.colliders.append(Collider("box", half, mid, friction=friction))
        return self

    def collide_cylinder(self, radius, z0, z1, x=0.0, y=0.0):
        self.colliders.append(Collider("cylinder", (radius, (z1 - z0) / 2), (x, y, (z0 + z1) / 2)))
        return self
