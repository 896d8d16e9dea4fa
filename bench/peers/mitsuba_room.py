"""Renders the scene that `path_rate --plain --export FOLDER` wrote with Mitsuba 3 (llvm_ad_rgb).

Same meshes, Lambertian materials, one emitter, camera, max_depth and resolution: the same work as
`path_rate --plain`. Prints paths per second of CPU time (at full use of all threads), kernels compiled before, as JSON.
Needs: pip install mitsuba numpy; DRJIT_LIBLLVM_PATH=/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1

    python mitsuba_room.py FOLDER [--spp 4] [--runs 5] [--picture out.png]
"""

import argparse
import json
import math
import os
import time

import mitsuba as mi

mi.set_variant("llvm_ad_rgb")
import drjit as dr  # noqa: E402


def load(folder):
    scene = {"type": "scene",
             "integrator": {"type": "path", "max_depth": 5, "rr_depth": 100}}
    for line in open(os.path.join(folder, "scene.txt")):
        word, *rest = line.split()
        if word == "camera":
            width, height = int(rest[0]), int(rest[1])
            fy, *values = [float(v) for v in rest[2:]]
            eye, direction = values[0:3], values[3:6]
            fov = 360 / math.pi * math.atan(0.5 * height / fy)
            scene["sensor"] = {
                "type": "perspective", "fov_axis": "y", "fov": fov,
                "to_world": mi.ScalarTransform4f().look_at(
                    origin=eye, target=[e + d for e, d in zip(eye, direction)], up=[0, 0, 1]),
                "film": {"type": "hdrfilm", "width": width, "height": height,
                         "rfilter": {"type": "box"}, "pixel_format": "rgb"},
                "sampler": {"type": "independent"}}
        elif word == "shape":
            name, smooth = rest[0], rest[1] == "1"
            color, emission = [float(v) for v in rest[2:5]], [float(v) for v in rest[5:8]]
            shape = {"type": "ply", "filename": os.path.join(folder, name),
                     "face_normals": not smooth,
                     "bsdf": {"type": "twosided", "bsdf": {
                         "type": "diffuse", "reflectance": {"type": "rgb", "value": color}}}}
            if max(emission) > 0:
                shape["emitter"] = {"type": "area",
                                    "radiance": {"type": "rgb", "value": emission}}
            scene[name.replace(".", "_")] = shape
    return mi.load_dict(scene), width, height


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--spp", type=int, default=4)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--picture")
    arguments = parser.parse_args()
    scene, width, height = load(arguments.folder)
    image = None
    times, walls = [], []
    for run in range(arguments.runs + 1):
        cpu, wall = time.process_time(), time.perf_counter()
        image = mi.render(scene, spp=arguments.spp, seed=run)
        dr.eval(image)
        dr.sync_thread()
        if run > 0:  # the first compiles
            times.append(time.process_time() - cpu)
            walls.append(time.perf_counter() - wall)
    seconds = sorted(times)[len(times) // 2]
    paths = width * height * arguments.spp
    threads = os.cpu_count()
    red = float(dr.mean(image.array[0::3])[0])
    print(json.dumps({"mpaths_per_s": paths / seconds * threads * 1e-6, "cpu_ms": seconds * 1e3,
                      "wall_ms": sorted(walls)[len(walls) // 2] * 1e3, "mean": red}))
    if arguments.picture:
        mi.util.write_bitmap(arguments.picture, image * (0.22 / 20))


if __name__ == "__main__":
    main()
