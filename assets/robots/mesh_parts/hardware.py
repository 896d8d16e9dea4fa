"""Screws, nuts, cable glands, cooling fins, vents and lenses. Each function adds to the mesh it gets."""

import numpy as np

from .boxes import block
from .mesh import basis, place
from .plates import circle, plate
from .turned import lathe


def bolt(mesh, at, axis, radius=0.0028, segments=10):
    """A button-head socket screw standing on `at`."""
    r = radius
    return mesh.add(*lathe([(r * 1.0, -0.2 * r), (r, 0.25 * r), (0.72 * r, 0.62 * r), (0.45 * r, 0.62 * r), (0.45 * r, 0.1 * r),
                            (0, 0.1 * r)], at, axis, segments=segments, bevel=0))


def bolt_circle(mesh, at, axis, circle, count, radius=0.0028, phase=0.0, segments=10):
    R = basis(axis)
    for k in range(count):
        t = 2 * np.pi * k / count + phase
        bolt(mesh, np.array(at) + R @ np.array([circle * np.cos(t), circle * np.sin(t), 0]), axis, radius, segments)


def socket_screw(mesh, at, axis, radius=0.003, segments=20):
    """A cylinder-head screw with a hexagon socket standing on `at`."""
    r = radius
    mesh.add(*lathe([(r, -0.1 * r), (r, 1.0 * r), (0.52 * r, 1.0 * r)], at, axis, segments=segments, bevel=0.12 * r, steps=1))
    R = basis(axis)
    hexagon = circle(0.52 * r, segments=6)
    ring = plate(circle(0.56 * r, segments=24), 0.35 * r, 0.995 * r, bevel=0, holes=[hexagon])
    floor = plate(circle(0.55 * r, segments=12), 0.2 * r, 0.4 * r, bevel=0)
    return mesh.add(*place(ring, at, R)).add(*place(floor, at, R))


def hex_nut(mesh, at, axis, width, height, bevel=0.0006):
    """A hexagon of this width across its flats standing on `at`."""
    return mesh.add(*place(plate(circle(width / np.sqrt(3), segments=6), 0, height, bevel=bevel), at, basis(axis)))


def cable_gland(mesh, at, axis, width=0.014):
    """Body, cap nut and collar of a cable gland standing on `at`; the cable leaves along the axis."""
    w = width
    R = basis(axis)
    hex_nut(mesh, at, axis, w, 0.30 * w)
    hex_nut(mesh, np.array(at) + R @ (0, 0, 0.36 * w), axis, 0.94 * w, 0.45 * w)
    return mesh.add(*lathe([(0.44 * w, 0.2 * w), (0.44 * w, 0.84 * w), (0.40 * w, 0.95 * w), (0.30 * w, 1.02 * w), (0.22 * w, 1.02 * w), (0.22 * w, 0.8 * w)],
                           at, axis, segments=28, bevel=0.04 * w))


def fins(mesh, center, half, count, along="x", thickness=0.001):
    """A row of cooling fins that fills a box, spaced along one axis."""
    k = "xyz".index(along)
    for offset in np.linspace(-1, 1, count):
        at, size = np.array(center, float), np.array(half, float)
        at[k] += offset * (half[k] - thickness / 2)
        size[k] = thickness / 2
        mesh.add(*block(at, size, 0.45 * thickness, steps=1))
    return mesh


def slots(mesh, center, step, count, half, radius):
    """A row of rounded bars: vents, grilles, LED bars."""
    for i in range(count):
        mesh.add(*block(np.array(center, float) + np.array(step, float) * (i - (count - 1) / 2), half, radius, steps=1))
    return mesh


def lens(glass, ring, at, axis, radius, depth=0.004, segments=36):
    """A camera lens: a stepped barrel in mesh `ring` and a domed front glass in mesh `glass`, its rim standing `depth`
    above `at`."""
    r, d = radius, depth
    ring.add(*lathe([(1.35 * r, -0.1 * d), (1.35 * r, d), (1.12 * r, d), (1.02 * r, 0.62 * d), (0.96 * r, 0.62 * d), (0.90 * r, 0.2 * d)],
                    at, axis, segments=segments, bevel=0.08 * r, steps=2 if segments > 30 else 1))
    dome = [(0.97 * r * np.sin(a), 0.3 * d + 0.3 * r * np.cos(a)) for a in np.linspace(np.pi / 2, 0, 7)]
    glass.add(*lathe(dome, at, axis, segments=segments - 4, bevel=0))
    return glass
