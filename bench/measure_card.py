"""What is measured on an NVIDIA card: `./gloam bench --device cuda`."""
import json

import go1_room
from measure import BIN, CACHE, at_most, robot, run

# 1280x720 in the same room, per work: the bar, and what the fastest peer on an H200 took by camera [ms].
BARS = {"direct": ("1280x720 primary + shadows", 0.5, {"far": 0.79, "close": 1.31}),
        "path 16": ("1280x720, 16 samples, depth 4", 25, {"far": 85.4, "close": 111})}
WHERE = {"far": "Go1 in a room", "close": "close to Go1"}


def card_rate(quick):
    """pictures of Go1 in a room on the card"""
    room = go1_room.write(CACHE / "bench_room", robot("go1"))
    cameras = [word for camera in WHERE for word in ("--camera", camera)]
    text = run(BIN / "bench_cuda_rate", room, *cameras, "--runs", 5 if quick else 40, "--json")
    for figures in map(json.loads, text.strip().splitlines()):
        what, bar, peers = BARS[figures["work"]]
        camera = figures["camera"]
        yield at_most(f"{what}, {WHERE[camera]} [ms]", figures["device_ms"], bar,
                      f"{figures['grays_per_s']:.1f} Grays/s; copy of the moved scene {figures['upload_ms']:.3f} ms, in all with the "
                      f"picture's way back {figures['wall_ms']:.1f} ms; best peer {peers[camera]} ms")


ALL = {card_rate: 60}
