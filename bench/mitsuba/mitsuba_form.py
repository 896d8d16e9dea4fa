"""Builds a scene for Mitsuba, from its own plug-ins wherever it has one of the same physics. The variant must be set."""
import json
import math

import lobe  # noqa: F401  registers gloam_lobe
import mitsuba as mi
import numpy as np
from description import linear, normalize, scaled, subtract
from gloam_files import write_obj
from mitsuba_light import environment_dict, lamp_dict, light_dict, rgb, volume_dict


def load(scene, folder, sampler="independent", roulette=1000):
    """mi.Scene; meshes go through files in `folder`. Paths may end by chance from the depth `roulette` on."""
    sky = scaled(scene.sky_radiance, scene.sky_scale)
    out = {"type": "scene", "integrator": {**integrator(scene), "rr_depth": roulette},
           "sensor": {**sensor(scene), "sampler": {"type": sampler}}}
    for i, shape in enumerate(scene.shapes):
        out[f"shape{i}"] = shape_dict(shape, folder / f"mitsuba_mesh{i}.obj")
    for i, light in enumerate(scene.lights):
        out[f"light{i}"] = light_dict(light, sky)
    for i, lamp in enumerate(scene.lamps):
        out[f"lamp{i}"] = lamp_dict(lamp, folder / f"mitsuba_lamp{i}.obj")
    for i, volume in enumerate(scene.volumes):
        out[f"volume{i}"] = volume_dict(volume)
    if scene.environment:
        out["environment"] = environment_dict(scene.environment)
    if scene.headlight is not None:  # docs/light.md
        out["headlight"] = {"type": "directional", "direction": list(normalize(subtract(scene.target, scene.eye))),
                            "irradiance": rgb(scaled(scene.headlight, 100 * math.pi))}
    if scene.sky_bytes:
        out["sky"] = {"type": "constant", "radiance": rgb(sky)}
    return mi.load_dict(out)


def integrator(scene):
    absorbs = any("transmission_depth" in m.layers for m in scene.materials)
    coloured = any(len(set(volume.extinction)) > 1 for volume in scene.volumes)  # which volpath takes one channel at a time
    return {"type": "volpathmis" if coloured else "volpath" if absorbs or scene.volumes else "path", "max_depth": scene.max_depth}


def sensor(scene):
    view = mi.ScalarTransform4f().look_at(origin=list(scene.eye), target=list(scene.target), up=[0, 0, 1])
    return {"type": "perspective", "fov_axis": "y", "fov": scene.fovy, "to_world": view,
            "film": {"type": "hdrfilm", "width": scene.size[0], "height": scene.size[1], "rfilter": {"type": "box"}}}


def shape_dict(shape, mesh_file):
    material = shape.material
    place = mi.ScalarTransform4f().translate(list(shape.position)).rotate([0, 0, 1], math.degrees(shape.turn))
    if shape.kind == "mesh":
        write_obj(mesh_file, shape.corners)
        out = {"type": "obj", "filename": str(mesh_file)}
    elif shape.kind == "sphere":
        out = {"type": "sphere", "center": list(shape.position), "radius": shape.size[0]}
    else:
        out = {"type": "cube", "to_world": place.scale(list(shape.size))}
    out["bsdf"] = bsdf_dict(material)
    if material.emission > 0:
        rows = material.maps.get("emissive")
        light = rgb(scaled(material.color, material.emission)) if rows is None else bitmap(rows, [material.emission] * 3)
        out["emitter"] = {"type": "area", "radiance": light}
    if material.layers.get("transmission_depth", 0) > 0:
        density = [-math.log(t) / material.layers["transmission_depth"] for t in material.layers["transmission_color"]]
        out["interior"] = {"type": "homogeneous", "albedo": 0.0, "scale": max(density), "sigma_t": rgb(scaled(density, 1 / max(density)))}
    return out


def bitmap(rows, factor=(1, 1, 1), display=True):
    """A texture of linear floats; `display`: texels are sRGB."""
    texels = np.array(rows, np.float64) / 255
    if display:
        texels = np.vectorize(linear)(texels)
    if texels.shape[2] == 3:
        texels = texels * np.array(factor)
    return {"type": "bitmap", "bitmap": mi.Bitmap(texels.astype(np.float32)), "raw": True, "filter_type": "bilinear",
            "wrap_mode": "repeat"}


def bsdf_dict(m):
    out = native_dict(m) if m.native else lobe_dict(m)
    if "normal" in m.maps:
        out = {"type": "normalmap", "normalmap": bitmap(m.maps["normal"], display=False), "bsdf": out,
               "use_shadowing_function": False, "flip_invalid_normals": False}
    if m.native in ("diffuse", "mirror", "white_metal"):
        out = {"type": "twosided", "bsdf": out}
    if "opacity" in m.maps:
        out = {"type": "mask", "opacity": bitmap(m.maps["opacity"], display=False), "bsdf": out}
    elif m.opacity < 1:
        out = {"type": "mask", "opacity": m.opacity, "bsdf": out}
    return out


def native_dict(m):
    scale = {name: m.lobes.get(name, 1.0) for name in lobe.LOBES}
    if m.native == "diffuse":
        return {"type": "diffuse", "reflectance": bitmap(m.maps["rgb"], m.color) if "rgb" in m.maps else rgb(m.color)}
    if m.native == "white_metal":  # without a colour both have no Fresnel term
        return {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": m.roughness**2}
    if m.native == "mirror":
        return {"type": "conductor", "material": "none", "specular_reflectance": rgb(scaled(m.color, scale["metal"]))}
    tint = m.layers.get("transmission_color", (1, 1, 1)) if m.layers.get("transmission_depth", 0) == 0 else (1, 1, 1)
    glass = {"int_ior": m.layers.get("ior", 1.5), "ext_ior": 1.0, "specular_reflectance": scale["reflection"],
             "specular_transmittance": rgb(scaled(tint, scale["transmission"]))}
    if m.native == "rough_glass":
        return {"type": "roughdielectric", "distribution": "ggx", "alpha": m.roughness**2, **glass}
    return {"type": {"glass": "dielectric", "pane": "thindielectric"}[m.native], **glass}


def lobe_dict(m):
    parameters = {"color": m.color, "metallic": m.metallic, "roughness": m.roughness, "specular": m.specular, **m.layers,
                  "scales": m.lobes}
    return {"type": "gloam_lobe", "parameters": json.dumps(parameters)}
