"""What is measured on an NVIDIA card: `./gloam bench --device cuda`."""
import json
import os
import tempfile
import time

import go1_room
from measure import BIN, CACHE, ROOT, at_least, at_most, robot, run, run_json
from measure_realistic import SCENES

# 1280x720 in the same room, per work and camera: the bar, and what the fastest peer on an H200 took [ms].
BARS = {"direct": ("1280x720 primary + shadows", {"far": (0.5, 0.79), "close": (0.5, 1.31)}),
        "path 16": ("1280x720, 16 samples, depth 4", {"far": (20, 85.4), "close": (25, 111)})}
# The same with the update of the scene before and the RGB image in the host's memory after it [ms].
WALLS = {"direct": {"far": 0.8, "close": 1.3}}
WHERE = {"far": "Go1 in a room", "close": "close to Go1"}
REALISTIC = {"house": 150, "demo_room": 60, "warehouse": 150}  # the same paths in scenes with materials, glass and many lamps [ms]


def card_rate(quick):
    """pictures of Go1 in a room on the card"""
    room = go1_room.write(CACHE / "bench_room", robot("go1"))
    cameras = [word for camera in WHERE for word in ("--camera", camera)]
    text = run(BIN / "bench_cuda_rate", room, *cameras, "--runs", 5 if quick else 40, "--json")
    for figures in map(json.loads, text.strip().splitlines()):
        if figures["work"] not in BARS:
            continue
        what, bars = BARS[figures["work"]]
        camera = figures["camera"]
        bar, peer = bars[camera]
        yield at_most(f"{what}, {WHERE[camera]} [ms]", figures["device_ms"], bar,
                      f"{figures['grays_per_s']:.1f} Grays/s; copy of the moved scene {figures['upload_ms']:.3f} ms, in all with the "
                      f"picture's way back {figures['wall_ms']:.1f} ms; best peer {peer} ms")
        if walls := WALLS.get(figures["work"]):
            yield at_most(f"the same, wall time with the RGB image in host memory, {WHERE[camera]} [ms]", figures["wall_ms"], walls[camera],
                          "update of the scene, ambient light, tone map and copy among it")


def realistic_card_rate(quick):
    """paths in realistic scenes on the card"""
    for scene, bar in REALISTIC.items():
        text = run(BIN / "bench_cuda_rate", SCENES / f"{scene}.toml", "--camera", "from", "--runs", 3 if quick else 20, "--json")
        figures = next(row for row in map(json.loads, text.strip().splitlines()) if row["work"] == "path 16")
        yield at_most(f"1280x720, 16 samples, depth 4, {scene} [ms]", figures["device_ms"], bar,
                      f"{figures['grays_per_s']:.2f} Grays/s; in all {figures['wall_ms']:.1f} ms")


def lidar_on_card(quick):
    """a LiDAR's scans of a house on the card"""
    figures = run_json(BIN / "bench_lidar_rate", ROOT / "bench" / "lidar_house.toml", "--card", "--runs", 3 if quick else 21, "--json")
    yield at_most("LiDAR of 64 x 1024 beams in the house, points in host memory [ms]", figures["card_ms"], 2, f"{figures['points']} points")


def demo_on_card(quick):
    """the demo with two cameras and video on the card"""
    took = {}
    for duration in (1, 3 if quick else 6):
        with tempfile.TemporaryDirectory(prefix="gloam_bench_") as folder:
            start = time.monotonic()
            run(BIN / "gloam", "run", ROOT / "examples" / "demo.toml", "--device", "cuda", "--spp", 16, "--output", "video", "--duration", duration,
                "--out", f"{folder}/demo")
            took[duration] = time.monotonic() - start
    (short, first), (long, last) = took.items()
    images = 2 * 20 * (long - short)
    yield at_least("demo.toml, two cameras of 640x480, 16 samples, denoised, with video: images a second", images / (last - first), 40,
                   f"between the runs of {short} and {long} s, which took {first:.1f} and {last:.1f} s")


def gas_on_card(quick):
    """smoke and fire on the card, beside all cores of its machine"""
    steps = ("--steps", 10 if quick else 60, "--threads", os.cpu_count(), "--json")
    card, cpu = (run_json(BIN / "bench_gas_rate", *steps, "--device", device) for device in ("cuda", "cpu"))
    rates = (f"{card['steps_per_s']:.0f} steps of 0.1 s a second against {cpu['steps_per_s']:.1f} on {cpu['threads']} threads; walls "
             f"{card['walls_ms']:.1f} ms and step {card['step_ms']:.2f} ms against {cpu['walls_ms']:.1f} ms and {cpu['step_ms']:.1f} ms")
    yield at_least("gas of 96 x 96 x 64 voxels, a step: the CPU's time / the card's", cpu["step_ms"] / card["step_ms"], 5, rates)
    yield at_least("the same with walls that move", card["steps_per_s"] / cpu["steps_per_s"], 3, f"on {card['device']}")
    yield at_most("the same: L2 norm of the divergence after / before, worst step", card["worst_divergence_ratio"], 1e-4, "something moves")


ALL = {card_rate: 60, lidar_on_card: 20, demo_on_card: 30, realistic_card_rate: 60, gas_on_card: 40}
