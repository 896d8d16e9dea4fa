"""Parts of the robots' drawn meshes, used by each robot's make_meshes.py. Needs numpy only; the same input gives the
same bytes. A part is (points, normals, texture coordinates, triangles), as Mesh.add takes them; lengths in metres."""

from .boxes import block, pill
from .hardware import bolt, bolt_circle, cable_gland, fins, hex_nut, lens, slots, socket_screw
from .lofted import grid_surface, loft
from .mesh import SHARP, Mesh, basis, fillet, mirrored, place, rotation_about, turned_by, unit, write_parts
from .plates import circle, plate, rounded, triangulate
from .swept import arc, blade, coil, spline, tube, wrap
from .turned import lathe

__all__ = [
    "SHARP", "Mesh", "arc", "basis", "blade", "block", "bolt", "bolt_circle", "cable_gland", "circle", "coil", "fillet", "fins", "grid_surface",
    "hex_nut", "lathe", "lens", "loft", "mirrored", "pill", "place", "plate", "rotation_about", "rounded", "slots", "socket_screw", "spline",
    "triangulate", "tube", "turned_by", "unit", "wrap", "write_parts",
]
