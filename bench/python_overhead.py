#!/usr/bin/env python3
"""What Python adds to Gloam: a step, a frame, a picture's arrays. `./gloam python bench/python_overhead.py`

The C++ side is bench_step_calls, which makes the same calls without Python, in turn with it, so that both see the same machine. Python's share is
the CPU time of the calling thread: the wall clock also tells how the thread that steps was scheduled, which differs more from run to run.
"""
from __future__ import annotations

import json
import statistics
import subprocess
import sys
import time
from pathlib import Path

import gloam

ROOT = Path(gloam.home())
STEPS, ROUNDS = 2000, 7


def python_step(sim: gloam.Simulation) -> tuple[float, float]:
    """Mean time of a call of step() [µs]: by the wall clock, and of the CPU and the calling thread alone."""
    sim.step(200)
    start, thread = time.perf_counter(), time.thread_time()
    for _ in range(STEPS):
        sim.step()
    return (time.perf_counter() - start) / STEPS * 1e6, (time.thread_time() - thread) / STEPS * 1e6


def call_cost(sim: gloam.Simulation) -> float:
    """What a call of step() costs beside the step [µs], by the wall clock: against the same steps in one call."""
    differences = []
    for _ in range(ROUNDS):
        sim.reset()
        one_by_one = python_step(sim)[0]
        sim.reset()
        sim.step(200)
        start = time.perf_counter()
        sim.step(STEPS)
        differences.append(one_by_one - (time.perf_counter() - start) / STEPS * 1e6)
    return statistics.median(differences)


def frame_access() -> tuple[float, float]:
    """Median time to take the arrays of a 640x480 frame that has come, with its pose and matrix [µs]: right after it was rendered, when caches
    hold the renderer's data, and once more."""
    sim = gloam.load(ROOT / "examples" / "two_robots.toml")
    camera = sim.cameras["chase"].open(("rgb", "depth"), width=640, height=480, tier="direct", spp=1, denoise=False)
    camera.next()
    cold, warm = [], []
    for _ in range(30):
        sim.run_until(step=sim.step_count + 60)
        camera._stream.flush()
        message = camera._stream.pop()
        for times in (cold, warm):
            start = time.perf_counter()
            frame = gloam.Frame(message)
            arrays = frame.rgb, frame.depth, frame.X_WC, frame.K, frame.stamp
            times.append((time.perf_counter() - start) * 1e6)
        assert arrays[0].shape == (480, 640, 3)
    sim.close()
    return statistics.median(cold), statistics.median(warm)


def main() -> None:
    program = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build" / "release" / "bin" / "bench_step_calls"
    rows = {}
    for name in ("assets/robots/quadruped/quadruped.xml", "examples/two_robots.toml", "examples/house.toml"):
        wall, caller, pure = [], [], []
        with gloam.load(ROOT / name) as sim:
            for _ in range(ROUNDS):
                told = subprocess.run([program, ROOT / name, str(STEPS)], check=True, text=True, stdout=subprocess.PIPE).stdout
                bare = json.loads(told)
                sim.reset()
                mine = python_step(sim)
                wall.append(mine[0] - bare["wall_us"])
                caller.append(mine[1] - bare["caller_us"])
                pure.append(bare["wall_us"])
            call = call_cost(sim)
        rows[name] = {"cpp_us": round(statistics.median(pure), 2), "python_adds_us": round(statistics.median(caller), 2),
                      "wall_difference_us": round(statistics.median(wall), 2), "call_us": round(call, 2)}
    print(json.dumps({"steps": rows, "frame_us": [round(us, 2) for us in frame_access()]}))


if __name__ == "__main__":
    main()
