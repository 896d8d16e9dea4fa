"""A call of gloam.distribute in a process of its own, which a test kills: python distribute_job.py SCENE OUT MARKS
COUNT."""

import os
import signal
import sys
import time
from pathlib import Path

import gloam
from gloam import distribute


def step(sim: gloam.Simulation, seed: int, folder: Path) -> dict[str, int]:
    """Writes its seed into MARKS when it begins, and a file of several parts."""
    marks = Path(os.environ["GLOAM_TEST_MARKS"])
    with open(marks / "begun", "a") as stream:
        stream.write(f"{seed}\n")
    for part in range(4):
        sim.step(5)
        time.sleep(0.05)
        with open(folder / "parts.txt", "a") as stream:
            stream.write(f"{seed} {part}\n")
    if seed == 3 and not (marks / "killed").exists():
        (marks / "killed").touch()
        os.kill(os.getpid(), 9)
    return {"twice": 2 * seed}


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # also where the test runs in the background
    os.environ["GLOAM_TEST_MARKS"] = sys.argv[3]
    report = distribute.rollouts(
        sys.argv[1], step, int(sys.argv[4]), out=sys.argv[2], topics=None, workers=2, progress=False
    )
    print(len(report.done))
