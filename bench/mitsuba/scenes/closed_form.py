"""Radiance of blocks of pixels where it has a closed form."""
import math

from description import BLOCK, SIZE, normalize, subtract

SUB = 4  # points of a pixel a side


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def blocks(scene, radiance):
    """Means of radiance(eye, unit direction) over each block; the pixel's filter is far below what varies here."""
    forward = normalize(subtract(scene.target, scene.eye))
    right = normalize(cross(forward, (0, 0, 1)))
    up = cross(right, forward)
    width, height = SIZE
    focal = 0.5 * height / math.tan(math.radians(scene.fovy) / 2)
    out = []
    for row in range(height // BLOCK):
        for column in range(width // BLOCK):
            total = [0.0, 0.0, 0.0]
            for i in range((BLOCK * SUB) ** 2):
                x = (column * BLOCK + (i % (BLOCK * SUB) + 0.5) / SUB - width / 2) / focal
                y = (height / 2 - row * BLOCK - (i // (BLOCK * SUB) + 0.5) / SUB) / focal
                direction = normalize(tuple(f + x * r + y * u for f, r, u in zip(forward, right, up)))
                total = [t + c for t, c in zip(total, radiance(scene.eye, direction))]
            out.append(tuple(t / (BLOCK * SUB) ** 2 for t in total))
    return out


def even(scene, radiance):
    return [radiance] * (SIZE[0] // BLOCK * (SIZE[1] // BLOCK))


def floor_point(eye, direction):
    """Where a ray meets z = 0."""
    t = -eye[2] / direction[2]
    return tuple(e + t * d for e, d in zip(eye, direction))


def polygon_irradiance(corners, p):
    """Of a facing-up surface at p per radiance of a polygon above it, seen anticlockwise from p (Lambert's formula)."""
    rays = [normalize(subtract(corner, p)) for corner in corners]
    total = 0.0
    for a, b in zip(rays, rays[1:] + rays[:1]):
        total += math.acos(max(-1, min(1, dot(a, b)))) * normalize(cross(a, b))[2]
    return abs(0.5 * total)


def sheet_reflects(cosine, ior):
    """Share that a clear sheet reflects, all the reflections inside it included."""
    cos_t = math.sqrt(1 - (1 - cosine * cosine) / ior**2)
    s, p = (cosine - ior * cos_t) / (cosine + ior * cos_t), (ior * cosine - cos_t) / (ior * cosine + cos_t)
    once = 0.5 * (s * s + p * p)
    return 2 * once / (1 + once)
