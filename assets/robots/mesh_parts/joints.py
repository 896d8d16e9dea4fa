"""Parts of driven joints: housings of motors, their covers, and the plates of forks. Each function adds to the mesh it gets."""

from .hardware import bolt_circle
from .plates import plate, rounded
from .turned import lathe

SIDES = (1, -1)


def housing(mesh, at, axis, low, high, radius, ribs=0, segments=34):
    """A motor's housing from `low` to `high` along an axis through `at`, with cooling ribs around its middle."""
    r = radius
    profile = [(0, low), (r - 0.003, low), (r, low + 0.003)]
    start = 0.5 * (low + high) - 0.0035 * ribs
    for k in range(ribs):
        h = start + 0.0070 * k
        profile += [(r, h), (r - 0.0018, h + 0.0006), (r - 0.0018, h + 0.0032), (r, h + 0.0038)]
    profile += [(r, high - 0.003), (r - 0.003, high), (0, high)]
    return mesh.add(*lathe(profile, at, axis, segments=segments, bevel=0))


def cap(mesh, at, axis, radius, height=0.009, segments=28):
    """The dished cover over the end of a joint, standing on `at`."""
    r, h = radius, height
    return mesh.add(*lathe([(r, -0.002), (r, h - 0.004), (r - 0.004, h), (r - 0.012, h), (r - 0.0135, h - 0.0016), (0, h - 0.0016)], at, axis,
                           segments=segments, bevel=0.0012, steps=1))


def cheeks(mesh, outline, radii, y, thickness, center=0.0, bevel=0.002):
    """A pair of plates left and right of the plane y = center, from distance `y` outwards; the outline is in (x, z)."""
    for s in SIDES:
        low, high = sorted((center + s * y, center + s * (y + thickness)))
        mesh.add(*plate(rounded([(z, x) for x, z in outline], radii, steps=5), low, high, "y", bevel=bevel, steps=2))
    return mesh


def end_bolts(mesh, at, y, circle_radius, count=5, radius=0.0019):
    """Bolt circles on both ends of a joint about y, at distance `y` from `at`."""
    for s in SIDES:
        bolt_circle(mesh, (at[0], at[1] + s * y, at[2]), "y" if s > 0 else "-y", circle_radius, count, radius, segments=8)
    return mesh
