"""A quadruped walks through a room and looks around; the walk is recorded, verified and seen again in fog.

./gloam python examples/python/quickstart.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import gloam


def main() -> None:
    out = Path(sys.argv[1] if len(sys.argv) > 1 else "results/quickstart")
    out.mkdir(parents=True, exist_ok=True)
    sim = gloam.load(gloam.home() / "examples" / "demo.toml", seed=7)
    dog = sim.robots["quadruped"]
    head = sim.cameras["quadruped/front"].open(("rgb", "depth"), width=160, height=120, rate=10, tier="direct", spp=4)
    with sim.record(out / "walk.mcap", topics=["/clock", "/tf*"], overwrite=True):
        dog.command(vx=0.5)
        while sim.time < 1:
            frame = sim.step_until(head)
            print(f"{frame.stamp:.2f} s: the nearest thing is {frame.depth.min():.2f} m away")
    print(f"the robot is at {dog.pose.p.round(2)}")
    frame.write(str(out), "head")
    sim.close()

    log = gloam.replay(out / "walk.mcap")
    assert log.verify().differing_steps == 0
    fog = {"weather.visibility": 12, "render.spp": 1}
    log.render(out / "fog.mp4", fog, camera="chase", width=120, height=90, rate=4, overwrite=True)
    print(f"see {out}")


if __name__ == "__main__":
    main()
