"""Lamps, media and skies of a scene as tables of Gloam's scene file."""
import math

from description import EvenSky
from gloam_files import toml_value, write_exr, write_ies, write_npy, write_obj

MAP_ROWS = 128  # of a sky's picture


def tables(scene, folder):
    out = [lamp_table(f"lamp{i}", lamp, folder) for i, lamp in enumerate(scene.lamps)]
    out += [volume_table(f"volume{i}", volume, folder) for i, volume in enumerate(scene.volumes)]
    return out + ([sky_table(scene.environment, folder)] if scene.environment else [])


def table(head, values):
    return f"{head}\n" + "".join(f"{key} = {value if isinstance(value, str) else toml_value(value)}\n" for key, value in values.items())


def lamp_table(name, lamp, folder):
    out = {"name": f'"{name}"', "type": '"point"' if lamp.kind == "profile" else f'"{lamp.kind}"', "position": lamp.position,
           "orientation": lamp.orientation, "color": lamp.color}
    if lamp.kind == "profile":
        write_ies(folder / f"{name}.ies", lamp.profile, lamp.strength)
        return table("[[light]]", {**out, "ies": f'"{name}.ies"'})
    out[lamp.unit] = lamp.strength
    if lamp.kind == "mesh":
        write_obj(folder / f"{name}.obj", lamp.corners)
        out["file"] = f'"{name}.obj"'
    elif lamp.kind == "rect":
        out["size"] = lamp.size
    else:
        out["radius"] = lamp.size[0]
    return table("[[light]]", out)


def volume_table(name, volume, folder):
    out = {"name": f'"{name}"', "position": volume.position, "orientation": volume.orientation, "size": volume.size,
           "mass_extinction": [*volume.extinction, 0, 0, 0], "albedo": [*volume.albedo, 0, 0, 0], "g": [volume.g], "density": 1.0}
    if volume.grid:
        write_npy(folder / f"{name}.npy", volume.grid)
        out["grid"] = f'"{name}.npy"'
    if volume.emission:
        out |= {"temperature": volume.temperature, "emission": volume.emission}
    return table("[[volume]]", out)


def sky_table(sky, folder):
    if isinstance(sky, EvenSky):
        return table("[sky]", {"luminance": sky.luminance, "color": sky.color})
    write_exr(folder / "sky.exr", [[sky.value(map_direction((x + 0.5) / (2 * MAP_ROWS), (y + 0.5) / MAP_ROWS))
                                    for x in range(2 * MAP_ROWS)] for y in range(MAP_ROWS)])
    return table("[sky]", {"file": '"sky.exr"', "illuminance": sky.illuminance, "turn": sky.turn})


def map_direction(u, v):
    """Of a point of an equirectangular picture: its middle is +X, its right half -Y, its top +Z (docs/light.md)."""
    a, b = 2 * math.pi * (0.5 - u), math.pi * v
    return (math.cos(a) * math.sin(b), math.sin(a) * math.sin(b), math.cos(b))
