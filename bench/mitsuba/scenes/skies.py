"""[sky]: even, and by a picture."""
from description import EvenSky, Scene, SkyMap, normalize
from scenes.registry import scene


def open_air(**more):
    s = Scene(eye=(0.4, -4.2, 2.0), target=(0, 0, 0.75), fovy=40, max_depth=8, **more)
    s.box(s.material("floor", color=(0.5, 0.5, 0.5), native="diffuse"), (0, 0, -0.05), (2.5, 2.5, 0.05))
    s.sphere(s.material("mirror", color=(1, 1, 1), metallic=1.0, roughness=0.0, native="mirror"), (-0.8, 0, 0.6), 0.6)
    s.sphere(s.material("metal", color=(0.9, 0.7, 0.4), metallic=1.0, roughness=0.5), (0.8, 0.4, 0.6), 0.6)
    s.box(s.material("box", color=(0.2, 0.4, 0.6), native="diffuse"), (0.35, -0.7, 0.2), (0.2, 0.2, 0.2), turn=0.6)
    return s


@scene("an even sky of a luminance and a colour")
def even_sky(k):
    s = open_air()
    s.environment = EvenSky(2000 * k("sky"), (0.6, 0.8, 1.0))
    return s


@scene("a sky by a picture, turned, with a bright patch")
def sky_map(k):
    s = open_air(spp=40, reference_spp=80)
    s.environment = SkyMap(illuminance=5000 * k("sky"), zenith=(0.5, 0.8, 1.6), nadir=(0.5, 0.3, 0.2), turn=40, patches=[
        (normalize((0.4, -0.8, 0.7)), 60.0, (60.0, 50.0, 35.0)), (normalize((-0.5, 0.9, 0.2)), 25.0, (2.0, 0.5, 3.0))])
    return s
