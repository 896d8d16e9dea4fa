"""Tubes and cables along a path, blades of propellers, and bending around a wheel."""

import numpy as np

from .lofted import grid_surface
from .mesh import unit


def spline(points, count=40):
    """Points on the uniform Catmull-Rom curve through the given ones."""
    p = np.array(points, float)
    p = np.concatenate([2 * p[:1] - p[1:2], p, 2 * p[-1:] - p[-2:-1]])
    s = np.linspace(0, len(p) - 3 - 1e-9, count)
    i, t = s.astype(int), (s % 1)[:, None]
    a, b, c, d = p[i], p[i + 1], p[i + 2], p[i + 3]
    return 0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3)


def tube(path, radius, segments=16):
    """A tube around a 3-D polyline; one radius, or one per point. Ends are flat."""
    p = np.array(path, float)
    d = unit(np.gradient(p, axis=0))
    helper = np.array([0, 0, 1.0]) if abs(d[0, 2]) < 0.9 else np.array([1.0, 0, 0])
    u = [unit(np.cross(helper, d[0]))]
    for direction in d[1:]:  # carried along without twist
        u.append(unit(u[-1] - direction * np.dot(u[-1], direction)))
    u = np.array(u)
    v = np.cross(d, u)
    t = np.linspace(0, 2 * np.pi, segments + 1)
    r = np.broadcast_to(radius, len(p))[:, None, None]
    return grid_surface(p[:, None] + r * (np.cos(t)[:, None] * u[:, None] + np.sin(t)[:, None] * v[:, None]))


def arc(section, start, end, at=(0, 0, 0), step=4.0, rounding=0.002):
    """Turns a closed outline of (radius, height) points about the z axis through `at`, from one angle to another
    [degrees]. The ends are rounded."""
    p = np.array(section, float)
    q = np.roll(p, -1, axis=0)
    if np.sum(p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]) < 0:
        p = p[::-1]
    p = np.concatenate([p, p[:1]])
    middle = 0.5 * (p.min(axis=0) + p.max(axis=0))
    half = 0.5 * (p.max(axis=0) - p.min(axis=0))
    cap = np.degrees(rounding / middle[0])
    a = np.linspace(0, np.pi / 2, 4)
    angles = np.concatenate([start + cap * (1 - np.cos(a)), np.linspace(start + cap, end - cap, max(3, int((end - start) / step)))[1:-1],
                             end - cap * (1 - np.cos(a[::-1]))])
    inset = np.concatenate([rounding * (1 - np.sin(a)), np.zeros(len(angles) - 8), rounding * (1 - np.sin(a[::-1]))])
    rows = []
    for angle, less in zip(np.radians(angles), inset):
        r, z = (middle + (p - middle) * np.maximum(1 - less / half, 0.05)).T
        rows.append(np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1) + np.array(at, float))
    return grid_surface(np.array(rows)[:, ::-1])


def coil(at, radius, wire, turns, pitch, segments=20, sides=8):
    """A helix about z from `at` upwards."""
    t = np.linspace(0, 2 * np.pi * turns, int(turns * segments) + 1)
    path = np.stack([radius * np.cos(t), radius * np.sin(t), pitch * t / (2 * np.pi)], axis=1)
    return tube(path + np.array(at, float), wire, sides)


def wrap(part, radius):
    """Bends a part around the y axis: x along the rim of a wheel of this radius, z outwards from it."""
    p, n, t, f = part
    a = p[:, 0] / radius
    r = radius + p[:, 2]
    s, c = np.sin(a), np.cos(a)
    return (np.stack([r * s, p[:, 1], r * c], axis=1), np.stack([n[:, 0] * c + n[:, 2] * s, n[:, 1], n[:, 2] * c - n[:, 0] * s], axis=1), t, f)


def blade(stations, sense=1, thickness=0.10, camber=0.05, points=28):
    """A propeller blade along x with its hub at the origin, thrust along z. A station is (r, chord, pitch angle in
    degrees, sweep, rise): radius, chord of the aerofoil, its incidence, and the offsets of its quarter chord along y
    and z. Sections are NACA four-digit aerofoils with their camber at 40 % (Jacobs, Ward and Pinkerton 1933).
    `sense` = 1 turns counterclockwise seen from above."""
    x = 0.5 * (1 - np.cos(np.linspace(0, 2 * np.pi, points + 1)))
    upper = np.linspace(0, 2 * np.pi, points + 1) <= np.pi
    rows = []
    for r, chord, pitch, sweep, rise in stations:
        half = 5 * thickness * (0.2969 * np.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4) + 0.004
        line = np.where(x < 0.4, camber / 0.16 * (0.8 * x - x * x), camber / 0.36 * (0.2 + 0.8 * x - x * x))
        y = chord * (0.25 - x)  # leading edge ahead
        z = chord * (line + np.where(upper, half, -half))
        z[0] = z[-1] = 0.5 * (z[0] + z[-1]) if chord else 0
        a = np.radians(pitch)
        rows.append(np.stack([np.full_like(y, r), sense * (y * np.cos(a) - z * np.sin(a) + sweep), y * np.sin(a) + z * np.cos(a) + rise], axis=1))
    grid = np.array(rows)
    return grid_surface(grid if sense > 0 else grid[:, ::-1])
