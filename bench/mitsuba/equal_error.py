"""Time to an equal error, Gloam's path tier against Mitsuba 3 (llvm_ad_rgb), in the rooms of rooms.py.

    python equal_error.py FOLDER PATH_BLOCKS [--rooms NAME,…] [--pictures 8] [--spp 16,64] [--samplers …]
Needs: pip install mitsuba numpy; DRJIT_LIBLLVM_PATH. Prints a line of JSON for each room.

Either program renders independent pictures of the same scene, size and depth, without denoising. The error is

    relMSE = mean of variance / (value² + (0.1 mean)²), over pixels and channels,

where the variance of one picture is that between the pictures, and `value` the mean of those of the most samples: the estimators have no bias but
what `agreement` finds, so this is the squared error against each program's own reference with the noise of the reference
taken off. Time is the CPU time of the rendering alone: scenes are loaded and kernels compiled before. Of Mitsuba's samplers,
the one with the least time times error counts (stratified and ldsampler, never found best, are tried where --samplers names them). At equal error, time goes as error x time, as error falls as 1 / time; the
slopes that were found are given.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import time
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
import agreement  # noqa: E402
import drjit as dr  # noqa: E402
import gloam_form  # noqa: E402
import mitsuba_form  # noqa: E402
import mitsuba_render  # noqa: E402
import rooms  # noqa: E402
from description import BLOCK, SIZE  # noqa: E402

SAMPLERS = ("independent", "multijitter", "orthogonal")


def rel_mse(runs):
    """By samples a pixel, of (seconds, pictures); values are those of the most samples."""
    value = runs[max(runs)][1].mean(axis=0)
    below = value**2 + (0.1 * value.mean()) ** 2
    return {spp: (seconds, float((pictures.var(axis=0, ddof=1) / below).mean())) for spp, (seconds, pictures) in runs.items()}


def gloam(program, scene, folder, name, spp, count, block=1):
    """(CPU seconds a picture, pictures of `block` pixels each)."""
    path = gloam_form.write(scene, folder / f"{name}.gloam")
    out = folder / f"{name}.blocks"
    done = subprocess.run([program, path, out, "--camera", gloam_form.CAMERA, "--spp", str(spp), "--batches", str(count), "--block", str(block)],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    head, raw = out.read_bytes().split(b"\n", 1)
    header = json.loads(head)
    width, height = scene.size[0] // block, scene.size[1] // block
    pictures = np.frombuffer(raw, np.float32)[:count * width * height * 3].reshape(count, -1)
    return header["cpu_of_batch"], pictures.astype(np.float64)


def mitsuba(scene, spp, count):
    """The same of Mitsuba; the first picture, which compiles, does not count."""
    seconds, pictures = [], []
    for seed in range(count + 1):
        cpu = time.process_time()
        picture = mi.render(scene, spp=spp, seed=seed + 1)
        dr.eval(picture)
        dr.sync_thread()
        if seed > 0:
            seconds.append(time.process_time() - cpu)
            pictures.append(np.array(picture, np.float64).ravel())
    return float(np.median(seconds)), np.array(pictures)


def agree(program, room, folder, name):
    """Both programs' means over blocks, as ./gloam mitsuba compares them."""
    scene, count, spp = room(SIZE), 32, 256  # with 16 batches of 128 the errors' tails raise false alarms
    _, ours = gloam(program, scene, folder, name, spp, count, BLOCK)
    loaded = mitsuba_form.load(scene, folder)
    rows, columns = SIZE[1] // BLOCK, SIZE[0] // BLOCK
    theirs = [mitsuba_render.render_batch(loaded, spp, seed).reshape(rows, BLOCK, columns, BLOCK, 3).mean(axis=(1, 3)).ravel()
              for seed in range(count)]
    return agreement.compare(agreement.estimate(ours.tolist()), agreement.estimate([list(batch) for batch in theirs]))


def slope(spps, work):
    """Of the error over time: -1 where it falls as 1 / time."""
    (t0, e0), (t1, e1) = work[spps[0]], work[spps[-1]]
    return math.log(e1 / e0) / math.log(t1 / t0)


def measure(program, name, folder, a):
    spps, room = [int(spp) for spp in a.spp.split(",")], rooms.ALL[name]
    found = agree(program, room, folder, name)
    ours = rel_mse({spp: gloam(program, room(), folder, name, spp, a.pictures) for spp in spps})
    theirs = {}
    for sampler in a.samplers.split(","):
        for roulette in (5, 1000):
            scene = mitsuba_form.load(room(), folder, sampler, roulette)
            theirs[f"{sampler}, roulette from {roulette}"] = rel_mse({spp: mitsuba(scene, spp, a.pictures) for spp in spps})
    product = {who: math.prod(t * e for t, e in work.values()) ** (1 / len(spps)) for who, work in theirs.items()}
    best = min(product, key=product.get)
    return {"room": name, "agrees": found.agrees, "agreement": str(found),
            "ratio": {spp: theirs[best][spp][0] * theirs[best][spp][1] / (ours[spp][0] * ours[spp][1]) for spp in spps},
            "best": best, "slopes": [slope(spps, ours), slope(spps, theirs[best])], "ours": ours, "theirs": theirs}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("program")
    parser.add_argument("--rooms", default=",".join(rooms.ALL))
    parser.add_argument("--pictures", type=int, default=8)
    parser.add_argument("--spp", default="16,64")
    parser.add_argument("--samplers", default=",".join(SAMPLERS))
    a = parser.parse_args()
    a.folder.mkdir(parents=True, exist_ok=True)
    # What Mitsuba has to say must not come between the lines of JSON.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    for name in a.rooms.split(","):
        found = measure(a.program, name, a.folder, a)
        print(f"{name}: " + ", ".join(f"{ratio:.2f} at {spp}" for spp, ratio in found["ratio"].items()), file=sys.stderr, flush=True)
        print(json.dumps(found), file=answers, flush=True)


if __name__ == "__main__":
    main()
