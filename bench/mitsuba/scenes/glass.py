"""Glass, sheets and gaps."""
from description import Scales, Scene, scaled
from scenes.materials import on_floor, trio
from scenes.registry import scene


@scene("clear and coloured solid glass")
def glass(k):
    s = on_floor(floor=(0.5, 0.4, 0.25), reference_spp=160)
    lobes = k.lobe("reflection") | k.lobe("transmission")
    trio(s, [s.material("clear", color=(1, 1, 1), roughness=0.0, native="glass", lobes=lobes, layers={"transmission_weight": 1, "ior": 1.5}),
             s.material("dense", color=(1, 1, 1), roughness=0.0, native="glass", lobes=lobes,
                        layers={"transmission_weight": 1, "ior": 1.7, "transmission_color": scaled((0.9, 0.6, 0.6), k("tint"))}),
             s.material("bottle", color=(1, 1, 1), roughness=0.0, native="glass", lobes=lobes,
                        layers={"transmission_weight": 1, "ior": 1.45, "transmission_depth": 0.5 / k("absorption"),
                                "transmission_color": (0.35, 0.8, 0.5)})])
    return s


@scene("glass of little roughness, against Mitsuba's own")
def ground_glass(k):
    s = on_floor(floor=(0.5, 0.4, 0.25))
    lobes = k.lobe("reflection") | k.lobe("transmission")
    trio(s, [s.material(f"ground{i}", color=(1, 1, 1), roughness=rough, native="rough_glass", lobes=lobes,
                        layers={"transmission_weight": 1, "ior": ior}) for i, (rough, ior) in enumerate([(0.1, 1.5), (0.15, 1.33)])])
    return s


@scene("rough glass, half glass and half plastic")
def rough_glass(k):
    s = on_floor(floor=(0.5, 0.4, 0.25))
    lobes = k.lobe("reflection") | k.lobe("transmission")
    trio(s, [s.material("ice", color=(1, 1, 1), roughness=0.4, lobes=lobes, layers={"transmission_weight": 1, "ior": 1.5}),
             s.material("milk", color=(1, 1, 1), roughness=0.7, lobes=lobes,
                        layers={"transmission_weight": 1, "ior": 1.33, "transmission_color": scaled((0.6, 0.8, 0.95), k("tint"))}),
             s.material("half", color=scaled((0.6, 0.2, 0.1), k("base")), roughness=0.5, specular=0.5, lobes=lobes,
                        layers={"transmission_weight": 0.5, "ior": 1.6})])
    return s


def behind(sheets, k=Scales()):
    """Upright sheets before a coloured ball and a wall, a panel behind them and the sky before. With `k` its lights can be scaled."""
    s = Scene(eye=(0, -4, 1.2), target=(0, 0, 0.9), fovy=38, max_depth=12, reference_spp=160)
    s.sky(k, 120, 120, 120)
    s.box(s.material("floor", color=(0.4, 0.4, 0.4), native="diffuse"), (0, 0, -0.05), (4, 4, 0.05))
    s.box(s.material("wall", color=(0.2, 0.35, 0.5), native="diffuse"), (0, 2, 1), (4, 0.05, 1))
    s.sphere(s.material("ball", color=(0.7, 0.3, 0.1), native="diffuse"), (0.1, 0.8, 0.5), 0.5)
    s.box(s.material("panel", color=(0.8, 0.8, 0.8), emission=700 * k("panel"), native="diffuse"), (0, 1.2, 2.6), (0.8, 0.3, 0.02))
    for i, material in enumerate(sheets(s)):
        x = -1.05 + 1.05 * i
        s.mesh(material, quad((x - 0.48, 0.1 * i, 0.05), (0.9, 0.3, 0), (0, 0, 1.7)))
    return s


def quad(corner, along, up):
    """Two triangles; u along the first edge, v along the second."""
    def at(u, v):
        return tuple(c + u * a + v * b for c, a, b in zip(corner, along, up))
    (ax, ay, az), (bx, by, bz) = along, up
    normal = (ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
    a, b, c, d = [(at(u, v), normal, (float(u), float(v))) for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))]
    return [a, b, c, a, c, d]


@scene("clear and tinted panes that lamps shine through")
def pane(k):
    lobes = k.lobe("reflection")
    return behind(lambda s: [
        s.material(f"pane{i}", color=(1, 1, 1), roughness=0.0, native="pane", lobes=lobes,
                   layers={"transmission_weight": 1, "thin_walled": True, "ior": ior, "transmission_color": scaled(tint, k("tint"))})
        for i, (ior, tint) in enumerate([(1.5, (0.95, 0.95, 0.95)), (1.5, (0.9, 0.4, 0.3)), (2.2, (0.4, 0.6, 0.9))])])


@scene("frosted panes")
def frosted(k):
    lobes = k.lobe("reflection") | k.lobe("transmission")
    return behind(lambda s: [
        s.material(f"frost{i}", color=(1, 1, 1), roughness=rough, lobes=lobes,
                   layers={"transmission_weight": 1, "thin_walled": True, "ior": ior, "transmission_color": tint})
        for i, (rough, ior, tint) in enumerate([(0.3, 1.5, (0.97, 0.97, 0.97)), (0.5, 2.0, (0.9, 0.5, 0.4)), (0.8, 2.4, (0.3, 0.5, 0.7))])])


@scene("leaves and paper: diffuse light through sheets")
def leaf(k):
    lobes = k.lobe("beyond") | k.lobe("diffuse") | k.lobe("layer")
    return behind(lambda s: [
        s.material(f"leaf{i}", color=color, roughness=0.5, specular=specular, lobes=lobes,
                   layers={"thin_walled": True, "subsurface_weight": weight, "subsurface_color": inside})
        for i, (color, specular, weight, inside) in enumerate([((0.1, 0.3, 0.05), 0.5, 0.6, (0.4, 0.9, 0.1)),
                                                               ((0.8, 0.8, 0.8), 0.0, 1.0, (0.9, 0.9, 0.85)),
                                                               ((0.5, 0.1, 0.1), 0.5, 0.3, (0.9, 0.3, 0.2))])])


@scene("surfaces that are partly there")
def opacity(k):
    return behind(lambda s: [
        s.material(f"veil{i}", color=scaled(color, k("veil")), opacity=alpha, native="diffuse")
        for i, (color, alpha) in enumerate([((0.8, 0.8, 0.8), 0.25), ((0.8, 0.2, 0.2), 0.5), ((0.1, 0.1, 0.1), 0.75)])], k)
