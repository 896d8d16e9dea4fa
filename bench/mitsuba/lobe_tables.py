"""Directional albedos that the published lobe is built with, by quadrature over visible normals.

Gloam reads its tables between nodes; so does this, at the same nodes, since what lies between them is part of the lobe.
The numbers at the nodes are computed here anew: other points, another way to draw normals, Mitsuba's double precision.
"""
import functools

import numpy as np

NODES = 32        # of roughness and of the cosine
GLASS_NODES = 16  # of roughness, of the cosine, and of the index of refraction
GRID = 384        # points of the quadrature a side


def ggx_alpha(roughness):
    return max(roughness * roughness, 1e-3)


def visible_normals(alpha, cosine):
    """Equally likely half vectors for a viewer in the xz plane (Heitz 2018, "Sampling the GGX distribution of visible normals")."""
    u = (np.arange(GRID) + 0.5) / GRID
    r, phi = np.meshgrid(np.sqrt(u), 2 * np.pi * u, indexing="ij")
    view = np.array([alpha * np.sqrt(1 - cosine * cosine), 0, cosine])
    view /= np.linalg.norm(view)
    across = np.array([0.0, 1.0, 0.0])
    up = np.cross(view, across)
    t1 = r * np.cos(phi)
    s = 0.5 * (1 + view[2])
    t2 = (1 - s) * np.sqrt(1 - t1 * t1) + s * r * np.sin(phi)
    third = np.sqrt(np.maximum(0, 1 - t1 * t1 - t2 * t2))
    n = t1[..., None] * across + t2[..., None] * up + third[..., None] * view
    n = np.stack([alpha * n[..., 0], alpha * n[..., 1], np.maximum(1e-9, n[..., 2])], -1)
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def smith(alpha, cosine):
    """Smith's Lambda for GGX."""
    c2 = np.clip(cosine * cosine, 1e-12, 1)
    return 0.5 * (np.sqrt(1 + alpha * alpha * (1 - c2) / c2) - 1)


def seen(alpha, cos_view, cos_light):
    """G2 / G1 of the height-correlated Smith function."""
    here, there = smith(alpha, cos_view), smith(alpha, np.abs(cos_light))
    return (1 + here) / (1 + here + there)


@functools.lru_cache
def layer_node(row, column):
    """Albedo of the layer = F0 a + F90 b."""
    alpha, cosine = ggx_alpha(row / (NODES - 1)), max(column / (NODES - 1), 2e-3)
    h = visible_normals(alpha, cosine)
    cos_h = h[..., 0] * np.sqrt(1 - cosine * cosine) + h[..., 2] * cosine
    cos_light = 2 * cos_h * h[..., 2] - cosine
    weight = np.where(cos_light > 0, seen(alpha, cosine, cos_light), 0)
    schlick = np.clip(1 - cos_h, 0, 1) ** 5
    return float(np.mean(weight * (1 - schlick))), float(np.mean(weight * schlick))


@functools.lru_cache
def fuzz_node(row, column):
    alpha, cosine = max((row / (NODES - 1)) ** 2, 1e-2), max(column / (NODES - 1), 2e-3)
    u = (np.arange(GRID) + 0.5) / GRID
    cos_light, phi = np.meshgrid(np.sqrt(u), np.pi * u, indexing="ij")  # by the cosine; half a turn says all
    sine, sine_view = np.sqrt(1 - cos_light**2), np.sqrt(1 - cosine**2)
    square = 2 + 2 * (cosine * cos_light + sine_view * sine * np.cos(phi))
    cos_h = (cosine + cos_light) / np.sqrt(square)
    return float(np.mean(fuzz_lobe(alpha, cosine, cos_light, np.sqrt(np.clip(1 - cos_h**2, 0, 1)))) * np.pi)


def fuzz_lobe(alpha, cos_view, cos_light, sin_h):
    """Charlie's distribution (Estevez and Kulla 2017) with the visibility of Neubelt and Pettineo (2013)."""
    distribution = (2 + 1 / alpha) * sin_h ** (1 / alpha) / (2 * np.pi)
    return distribution / (4 * (cos_view + cos_light - cos_view * cos_light))


@functools.lru_cache
def glass_node(plane, row, column):
    """Of single scattering on glass, to both sides."""
    axis = 2 * plane / (GLASS_NODES - 1) - 1
    eta = (2 + axis) / (2 - axis)
    alpha, cosine = ggx_alpha(row / (GLASS_NODES - 1)), max(column / (GLASS_NODES - 1), 1e-2)
    h = visible_normals(alpha, cosine)
    cos_h = h[..., 0] * np.sqrt(1 - cosine * cosine) + h[..., 2] * cosine
    sin2 = (1 - cos_h**2) / eta**2
    cos_t = np.sqrt(np.maximum(0, 1 - sin2))
    rs, rp = (cos_h - eta * cos_t) / (cos_h + eta * cos_t), (eta * cos_h - cos_t) / (eta * cos_h + cos_t)
    reflects = np.where(sin2 >= 1, 1, 0.5 * (rs**2 + rp**2))
    mirrored = 2 * cos_h * h[..., 2] - cosine
    bent = (cos_h / eta - cos_t) * h[..., 2] - cosine / eta
    total = np.where(mirrored > 0, reflects * seen(alpha, cosine, mirrored), 0)
    return float(np.mean(total + np.where((bent < 0) & (reflects < 1), (1 - reflects) * seen(alpha, cosine, bent), 0)))


def between(place, nodes):
    low = int(min(max(place, 0) * (nodes - 1), nodes - 1.001))
    return low, place * (nodes - 1) - low


def layer_columns(roughness):
    """Two rows of values over the cosine, for a and b."""
    row, share = between(min(max(roughness, 0), 1), NODES)
    low, high = (np.array([layer_node(r, column) for column in range(NODES)]) for r in (row, row + 1))
    return ((1 - share) * low + share * high).T


def fuzz_columns(roughness):
    row, share = between(min(max(roughness, 0), 1), NODES)
    low, high = (np.array([fuzz_node(r, column) for column in range(NODES)]) for r in (row, row + 1))
    return (1 - share) * low + share * high


def glass_columns(roughness, eta):
    plane, depth = between(0.5 * (min(max(2 * (eta - 1) / (eta + 1), -1), 1) + 1), GLASS_NODES)
    row, share = between(min(max(roughness, 0), 1), GLASS_NODES)

    def at(p, r):
        return np.array([glass_node(p, r, column) for column in range(GLASS_NODES)])

    low, high = ((1 - share) * at(p, row) + share * at(p, row + 1) for p in (plane, plane + 1))
    return (1 - depth) * low + depth * high
