"""Lamps, media and skies of a scene for Mitsuba. The variant must be set."""
import json
import math

import mitsuba as mi
import numpy as np
import spot  # noqa: F401  registers gloam_spot and gloam_profile
from description import EvenSky, normalize, rotation, scaled
from gloam_files import write_obj
from gloam_light import MAP_ROWS, map_direction

FAR = 1e4  # [m] of a sun that is a disc


def rgb(color):
    return {"type": "rgb", "value": list(map(float, color))}


def light_dict(light, behind):
    """`behind`: radiance of the sky, which a far disc would hide."""
    if light.kind == "spot":
        return {"type": "gloam_spot", "position": list(light.position), "direction": list(normalize(light.direction)),
                "intensity_rgb": list(light.intensity), "cutoff": light.cutoff, "inner": light.cutoff * (1 - light.softness)}
    radius, place, hidden = light.radius, list(light.position), (0, 0, 0)
    if light.kind == "directional":
        axis = normalize(light.direction)
        if radius == 0:
            return {"type": "directional", "direction": list(axis), "irradiance": rgb(light.intensity)}
        radius, place, squared, hidden = FAR * radius, [-FAR * x for x in axis], radius**2, behind
    elif radius == 0:
        return {"type": "point", "position": place, "intensity": rgb(light.intensity)}
    else:
        squared = radius**2
    return {"type": "sphere", "center": place, "radius": radius, "bsdf": {"type": "diffuse", "reflectance": 0.0},
            "emitter": {"type": "area", "radiance": rgb(i / (math.pi * squared) + h for i, h in zip(light.intensity, hidden))}}


def placed(position, orientation):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation(orientation), position
    return mi.ScalarTransform4f(matrix)


def lamp_dict(lamp, mesh_file):
    place = placed(lamp.position, lamp.orientation)
    if lamp.kind == "profile":
        return {"type": "gloam_profile", "parameters": json.dumps({
            "position": lamp.position, "rotation": rotation(lamp.orientation), "candela": lamp.profile,
            "scale": scaled(lamp.hue(), lamp.strength)})}
    if lamp.kind == "mesh":
        write_obj(mesh_file, lamp.corners)
        out = {"type": "obj", "filename": str(mesh_file), "face_normals": True, "to_world": place}
    elif lamp.kind == "sphere":
        out = {"type": "sphere", "center": list(lamp.position), "radius": lamp.size[0]}
    else:  # they face +Z
        half = [lamp.size[0] / 2, lamp.size[1] / 2, 1] if lamp.kind == "rect" else [lamp.size[0], lamp.size[0], 1]
        out = {"type": {"rect": "rectangle", "disk": "disk"}[lamp.kind], "to_world": place.rotate([1, 0, 0], 180).scale(half)}
    return {**out, "bsdf": {"type": "diffuse", "reflectance": 0.0}, "emitter": {"type": "area", "radiance": rgb(lamp.radiance())}}


def volume_dict(volume):
    place = placed(volume.position, volume.orientation)
    most = max(volume.extinction)
    medium = {"albedo": rgb(volume.albedo), "scale": most, "phase": {"type": "hg", "g": volume.g}}
    if volume.grid:
        if len(set(volume.extinction)) > 1:
            raise ValueError("grids of one extinction for all channels only")
        grid = np.array(volume.grid, np.float32)[..., None]
        medium |= {"type": "heterogeneous", "sigma_t": {
            "type": "gridvolume", "grid": mi.VolumeGrid(grid), "filter_type": "trilinear", "wrap_mode": "clamp", "raw": True,
            "to_world": place.scale(list(volume.size)).translate([-0.5] * 3)}}
    else:
        medium |= {"type": "homogeneous", "sigma_t": rgb(scaled(volume.extinction, 1 / most))}
    return {"type": "cube", "to_world": place.scale([edge / 2 for edge in volume.size]), "bsdf": {"type": "null"}, "interior": medium}


def environment_dict(sky):
    if isinstance(sky, EvenSky):
        return {"type": "constant", "radiance": rgb(sky.radiance(None))}
    # Texels of Mitsuba's map: the first and the last row lie on the poles, and +X is a quarter from the left (both measured).
    width, height = 2 * MAP_ROWS, MAP_ROWS + 1
    texels = [[sky.value(map_direction((x + 0.5) / width + 0.25, y / MAP_ROWS)) for x in range(width)] for y in range(height)]
    return {"type": "envmap", "bitmap": mi.Bitmap(np.array(texels, np.float32)), "scale": sky.scale(),
            "to_world": mi.ScalarTransform4f().rotate([0, 0, 1], sky.turn).rotate([1, 0, 0], 90)}
