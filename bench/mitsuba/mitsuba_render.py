"""Renders scenes with Mitsuba 3 (llvm_ad_rgb): means over blocks of pixels, in independent batches.

Needs: pip install mitsuba numpy; DRJIT_LIBLLVM_PATH. Called by judge.py, one process for many pictures:
    python mitsuba_render.py FOLDER < JSON lines {"scene": …, "scaled": name of what is scaled by 3 % or "", "batches": …}
Writes FOLDER/SCENE.SCALED.mitsuba in the format of bench/path_blocks.cc and prints a line with "file" as each is done.
"""
import json
import sys
import time
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
import drjit as dr  # noqa: E402
import mitsuba_form  # noqa: E402
import scenes  # noqa: E402
from description import BLOCK, FILTER_CUT, FILTER_SIGMA, SIZE, Scales  # noqa: E402


def render_batch(scene, spp, seed):
    """(height, width, 3) of one batch."""
    width, height = SIZE
    count = width * height * spp
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(seed, count)
    pixel = dr.arange(mi.UInt32, count) // spp
    u = sampler.next_2d()
    radius = FILTER_SIGMA * dr.sqrt(-2 * dr.log(1 - u.x * (1 - np.exp(-0.5 * (FILTER_CUT / FILTER_SIGMA) ** 2))))
    s, c = dr.sincos(2 * dr.pi * u.y)
    place = mi.Point2f(mi.Float(pixel % width) + 0.5 + radius * c, mi.Float(pixel // width) + 0.5 + radius * s)
    ray, weight = scene.sensors()[0].sample_ray(0, 0.5, place / mi.Point2f(width, height), mi.Point2f(0.5))
    light, _, _ = scene.integrator().sample(scene, sampler, mi.RayDifferential3f(ray))
    light = np.array(light * weight, np.float32).reshape(3, height, width, spp)
    return light.mean(axis=3, dtype=np.float64).transpose(1, 2, 0)


def render(name, scaled, batches, path):
    description = scenes.ALL[name].describe(Scales(scaled))
    scene = mitsuba_form.load(description, path.parent)
    width, height = SIZE
    spp = description.reference_spp
    blocks, picture = [], np.zeros((height, width, 3))
    for seed in range(batches):
        one = render_batch(scene, spp, seed)
        picture += one / batches
        blocks.append(one.reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, 3).mean(axis=(1, 3)))
    header = {"width": width, "height": height, "block": BLOCK, "batches": batches, "spp": spp, "mitsuba": mi.__version__}
    path.write_bytes(json.dumps(header).encode() + b"\n" + np.array(blocks, np.float32).tobytes() + picture.astype(np.float32).tobytes())


def main():
    folder = Path(sys.argv[1])
    for line in sys.stdin:
        job, start = json.loads(line), time.time()
        job["file"] = f"{job['scene']}.{job['scaled']}.mitsuba"
        render(job["scene"], job["scaled"], job["batches"], folder / job["file"])
        print(json.dumps({**job, "seconds": round(time.time() - start, 1)}), flush=True)


if __name__ == "__main__":
    main()
