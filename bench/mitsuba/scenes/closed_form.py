"""Radiance of blocks of pixels where it has a closed form."""
import math

from description import BLOCK, FILTER_CUT, FILTER_SIGMA, SIZE, normalize, subtract

POINTS = 16  # of a pixel


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def blocks(scene, radiance):
    """Means of radiance(eye, unit direction) over each block, as the pixel's filter sees it."""
    forward = normalize(subtract(scene.target, scene.eye))
    right = normalize(cross(forward, (0, 0, 1)))
    up = cross(right, forward)
    width, height = SIZE
    focal = 0.5 * height / math.tan(math.radians(scene.fovy) / 2)
    spread = filter_points(BLOCK**2 * POINTS)
    out = []
    for row in range(height // BLOCK):
        for column in range(width // BLOCK):
            total = [0.0, 0.0, 0.0]
            for i, (dx, dy) in enumerate(spread):
                pixel = i // POINTS
                x = (column * BLOCK + pixel % BLOCK + 0.5 + dx - width / 2) / focal
                y = (height / 2 - row * BLOCK - pixel // BLOCK - 0.5 - dy) / focal
                direction = normalize(tuple(f + x * r + y * u for f, r, u in zip(forward, right, up)))
                total = [t + c for t, c in zip(total, radiance(scene.eye, direction))]
            out.append(tuple(t / len(spread) for t in total))
    return out


def filter_points(count):
    """Offsets from a pixel's centre by its filter [px]: Roberts' R2 sequence, in pairs whose mean is zero."""
    cut, out = 1 - math.exp(-0.5 * (FILTER_CUT / FILTER_SIGMA) ** 2), []
    for i in range(1, count // 2 + 1):
        u, v = i * 0.7548776662466927 % 1, i * 0.5698402909980532 % 1
        radius = FILTER_SIGMA * math.sqrt(-2 * math.log(1 - u * cut))
        x, y = radius * math.cos(2 * math.pi * v), radius * math.sin(2 * math.pi * v)
        out += [(x, y), (-x, -y)]
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
