"""Surfaces of revolution."""

import numpy as np

from .mesh import SHARP, basis, fillet, unit


def lathe(profile, at, axis, segments=40, bevel=0.0015, steps=2):
    """Turns a profile of (radius, height) points about the axis; height runs along it. Listed from the bottom of the
    outside up, the surface faces outwards."""
    profile = fillet(profile, bevel, steps) if bevel > 0 else np.array(profile, float)
    d = np.diff(profile, axis=0)
    keep = np.linalg.norm(d, axis=1) > 1e-7
    profile = np.concatenate([profile[:1], profile[1:][keep]])
    d = unit(np.diff(profile, axis=0))
    side = np.stack([d[:, 1], -d[:, 0]], axis=1)  # outward normal of each piece
    # One ring per piece end, shared where the edge is smooth.
    rings, normals, pieces = [profile[0]], [side[0]], []
    for i in range(len(d)):
        start = len(rings) - 1
        last = i + 1 == len(d)
        smooth = not last and np.dot(side[i], side[i + 1]) > SHARP
        rings.append(profile[i + 1])
        normals.append(unit(side[i] + side[i + 1]) if smooth else side[i])
        pieces.append((start, start + 1))
        if not last and not smooth:
            rings.append(profile[i + 1])
            normals.append(side[i + 1])
    rings, normals = np.array(rings), np.array(normals)
    angle = np.linspace(0, 2 * np.pi, segments + 1)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    R = basis(axis)
    local = np.concatenate([rings[:, None, :1] * ring, np.broadcast_to(rings[:, None, 1:], (len(rings), segments + 1, 1))], axis=2)
    bent = np.concatenate([normals[:, None, :1] * ring, np.broadcast_to(normals[:, None, 1:], (len(rings), segments + 1, 1))], axis=2)
    u, v = np.meshgrid(angle / (2 * np.pi), np.linspace(0, 1, len(rings)))
    faces = []
    for a, b in pieces:
        for j in range(segments):
            q = (a * (segments + 1) + j, a * (segments + 1) + j + 1, b * (segments + 1) + j + 1, b * (segments + 1) + j)
            faces += [(q[0], q[1], q[2]), (q[0], q[2], q[3])]
    return (local.reshape(-1, 3) @ R.T + np.array(at), bent.reshape(-1, 3) @ R.T,
            np.stack([u.ravel(), v.ravel()], axis=1), faces)
