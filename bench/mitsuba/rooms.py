"""Three rooms in which the time to an equal error is measured. Mitsuba has each material, lamp and sky of its own."""
from description import Scene, SkyMap, normalize

SIZE = (320, 240)


def shell(s, x, y, z, window=False):
    """A room of half edges x and y and the height z, its floor at the origin; the camera stands inside."""
    white = s.material("white", color=(0.75, 0.73, 0.7), native="diffuse")
    wood = s.material("wood", color=(0.4, 0.25, 0.13), native="diffuse")
    blue = s.material("blue", color=(0.2, 0.3, 0.5), native="diffuse")
    t = 0.1
    s.box(wood, (0, 0, -t), (x + 2 * t, y + 2 * t, t))
    s.box(white, (0, 0, z + t), (x + 2 * t, y + 2 * t, t))
    s.box(white, (0, y + t, z / 2), (x, t, z / 2))
    s.box(white, (0, -y - t, z / 2), (x, t, z / 2))
    s.box(blue, (-x - t, 0, z / 2), (t, y, z / 2))
    if not window:
        s.box(white, (x + t, 0, z / 2), (t, y, z / 2))
        return
    low, high, half, middle = 0.8, 2.2, 0.8, 0.3  # of the window in the wall of +X
    s.box(white, (x + t, 0, low / 2), (t, y, low / 2))
    s.box(white, (x + t, 0, (high + z) / 2), (t, y, (z - high) / 2))
    for a, b in ((-y, middle - half), (middle + half, y)):
        s.box(white, (x + t, (a + b) / 2, (low + high) / 2), (t, (b - a) / 2, (high - low) / 2))


def furnish(s):
    dark = s.material("dark", color=(0.15, 0.1, 0.08), native="diffuse")
    red = s.material("red", color=(0.55, 0.12, 0.1), native="diffuse")
    green = s.material("green", color=(0.2, 0.45, 0.2), native="diffuse")
    s.box(dark, (0.2, 0.6, 0.72), (0.8, 0.45, 0.02))
    for x in (-0.55, 0.95):
        for y in (0.2, 1.0):
            s.box(dark, (x, y, 0.35), (0.03, 0.03, 0.345))
    s.box(red, (-1.6, 0.4, 0.22), (0.4, 0.9, 0.2))
    s.box(red, (-1.9, 0.4, 0.6), (0.1, 0.9, 0.17))
    for i in range(4):
        s.box(dark, (1.0, 1.9, 0.4 + 0.45 * i), (0.7, 0.14, 0.015))
        for j in range(5):
            s.box((red, green, dark)[(i + j) % 3], (0.5 + 0.22 * j, 1.9, 0.53 + 0.45 * i), (0.03 + 0.01 * j, 0.1, 0.11))
    s.sphere(green, (0.6, 0.7, 0.85), 0.1)


def camera(size):
    return Scene(eye=(-0.6, -1.9, 1.5), target=(0.15, 0.8, 0.95), fovy=55, max_depth=8, size=size)


def panel_room(size=SIZE):
    """A furnished room under a ceiling panel, a lamp on the table."""
    s = camera(size)
    shell(s, 2.2, 2.1, 2.6)
    furnish(s)
    s.lamp("rect", "flux", 3600, position=(0, 0.2, 2.58), size=(1.2, 0.6))
    s.lamp("sphere", "flux", 500, color=(1, 0.75, 0.5), position=(-0.2, 0.6, 0.95), size=(0.1,))
    return s


def window_room(size=SIZE):
    """The same by day: a window, a sky by a picture, the sun."""
    s = camera(size)
    shell(s, 2.2, 2.1, 2.6, window=True)
    furnish(s)
    s.environment = SkyMap(illuminance=15000, zenith=(0.4, 0.7, 1.4), nadir=(0.25, 0.22, 0.2),
                           patches=[(normalize((0.8, -0.35, 0.5)), 40.0, (8.0, 7.0, 6.0))])
    s.light("directional", (60000, 56000, 48000), direction=(-0.8, 0.35, -0.5), radius=0.02)
    return s


def lamps_room(size=SIZE):
    """Glass, metal and sixteen small lamps."""
    s = camera(size)
    shell(s, 2.2, 2.1, 2.6)
    furnish(s)
    # Smooth: Mitsuba's rough metal loses the light that it scatters more than once, 9 % of what grazes it at a roughness of 0.25.
    metal = s.material("metal", color=(1, 1, 1), metallic=1.0, roughness=0.15, native="white_metal")
    mirror = s.material("mirror", color=(1, 1, 1), metallic=1.0, roughness=0.0, native="mirror")
    glass = s.material("glass", color=(1, 1, 1), roughness=0.0, native="glass", layers={"transmission_weight": 1, "ior": 1.5})
    s.sphere(metal, (-0.25, 0.5, 0.89), 0.15)
    s.sphere(glass, (0.2, 0.4, 0.86), 0.12)
    s.box(mirror, (-2.18, 0.6, 1.5), (0.01, 0.6, 0.4))
    s.box(metal, (1.2, -0.2, 0.3), (0.25, 0.25, 0.299), turn=0.5)
    for i in range(16):
        color = ((1, 0.6, 0.3), (0.5, 0.7, 1), (1, 0.9, 0.8), (0.5, 1, 0.6))[i % 4]
        s.lamp("sphere", "flux", 60 + 15 * i, color=color, position=(-1.6 + 1.05 * (i % 4), -1.4 + 0.95 * (i // 4), 2.3 - 0.07 * (i % 3)), size=(0.09,))
    return s


ALL = {"panel_room": panel_room, "window_room": window_room, "lamps_room": lamps_room}
