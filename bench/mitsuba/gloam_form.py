"""Writes a scene for Gloam: MJCF with its textures and meshes, and a scene file with what MJCF cannot say."""
import math

import gloam_light
from description import display, luminance, normalize
from gloam_files import numbers, toml_value, write_obj, write_png

CAMERA = "judge"


def write(scene, folder):
    """Returns the path of the scene file."""
    folder.mkdir(parents=True, exist_ok=True)
    assets, geoms = [], []
    if scene.sky_bytes:
        rgb = numbers(byte / 255 for byte in scene.sky_bytes)
        assets.append(f'<texture type="skybox" builtin="flat" rgb1="{rgb}" rgb2="{rgb}" width="8" height="48"/>')
    for material in scene.materials:
        assets += material_assets(material, folder)
    for i, shape in enumerate(scene.shapes):
        place = f'pos="{numbers(shape.position)}" euler="0 0 {shape.turn!r}"'
        if shape.kind == "mesh":
            write_obj(folder / f"mesh{i}.obj", shape.corners)
            assets.append(f'<mesh name="mesh{i}" file="mesh{i}.obj" inertia="shell"/>')
            geoms.append(f'<geom type="mesh" mesh="mesh{i}" material="{shape.material.name}"/>')
        else:
            geoms.append(f'<geom type="{shape.kind}" size="{numbers(shape.size)}" {place} material="{shape.material.name}"/>')
    head = 'active="0"' if scene.headlight is None else f'active="1" diffuse="{numbers(scene.headlight)}" ambient="0 0 0"'
    (folder / "scene.xml").write_text("\n".join([
        '<mujoco><compiler angle="radian"/><statistic center="0 0 0" extent="4"/>', f"<visual><headlight {head}/></visual>",
        "<asset>", *assets, "</asset>", '<default><geom contype="0" conaffinity="0"/></default>',
        "<worldbody>", *(light_element(light) for light in scene.lights), *geoms, "</worldbody></mujoco>", ""]))
    path = folder / "scene.toml"
    path.write_text("\n".join(['[environment]\nfile = "scene.xml"\n', camera_table(scene), f"[render]\nmax_depth = {scene.max_depth}\n",
                               *(material_table(material) for material in scene.materials if material.layers), *gloam_light.tables(scene, folder)]))
    return path


def camera_table(scene):
    return (f'[[camera]]\nname = "{CAMERA}"\nposition = {list(map(float, scene.eye))}\nlook_at = {list(map(float, scene.target))}\n'
            f"fovy = {float(scene.fovy)}\nwidth = {scene.size[0]}\nheight = {scene.size[1]}\n")


def material_table(material):
    return f'[[material]]\nname = "{material.name}"\n' + "".join(f"{key} = {toml_value(v)}\n" for key, v in material.layers.items())


def material_assets(material, folder):
    rgba = numbers([*map(display, material.color), material.opacity])
    out, layers = [], []
    for role, rows in material.maps.items():
        file = f"{material.name}_{role}.png"
        write_png(folder / file, rows)
        channels = "" if len(rows[0][0]) == 3 else f' nchannel="{len(rows[0][0])}"'
        out.append(f'<texture name="{material.name}_{role}" type="2d" file="{file}"{channels}/>')
        layers.append(f'<layer role="{role}" texture="{material.name}_{role}"/>')
    out.append(f'<material name="{material.name}" rgba="{rgba}" metallic="{material.metallic!r}" roughness="{material.roughness!r}" '
               f'specular="{material.specular!r}" emission="{material.emission / 100!r}">{"".join(layers)}</material>')
    return out


def light_element(light):
    place = f'pos="{numbers(light.position)}" dir="{numbers(normalize(light.direction))}"'
    shape = f'bulbradius="{light.radius!r}"'
    if light.kind == "spot":
        shape += f' cutoff="{math.degrees(light.cutoff)!r}" softness="{light.softness!r}"'
    if not light.legacy:
        candela = luminance(light.intensity)
        colour = f'intensity="{candela!r}" diffuse="{numbers(c / candela for c in light.intensity)}"'
    else:  # docs/light.md: as bright as it makes white at the model's centre, which is the origin
        square = 1 if light.kind == "directional" else max(sum(x * x for x in light.position), 1)
        colour = f'diffuse="{numbers(c / (100 * math.pi * square) for c in light.intensity)}"'
    return f'<light type="{light.kind}" {place} {shape} {colour} ambient="0 0 0" specular="0 0 0" castshadow="true"/>'
