"""What is measured on an NVIDIA card: `./gloam bench --device cuda`."""
import json

import go1_room
from measure import BIN, CACHE, at_most, robot, run

# 1280x720 in the same room, per work: what the fastest peer on an H200 took, and the bar [ms].
BARS = {"direct": ("1280x720 primary + shadows, Go1 in a room", 0.79, 0.5),
        "path 16": ("1280x720, 16 samples, depth 4, Go1 in a room", 85.4, 25)}


def card_rate(quick):
    """pictures of Go1 in a room on the card"""
    room = go1_room.write(CACHE / "bench_room", robot("go1"))
    text = run(BIN / "bench_cuda_rate", room, "--camera", "far", "--camera", "close", "--runs", 5 if quick else 40, "--json")
    figures = [json.loads(line) for line in text.strip().splitlines()]
    for work, (what, peer, bar) in BARS.items():
        by_camera = {f["camera"]: f for f in figures if f["work"] == work}
        far = by_camera["far"]
        yield at_most(f"{what} [ms]", far["device_ms"], bar,
                      f"robot near: {by_camera['close']['device_ms']:.2f} ms; {far['grays_per_s']:.1f} Grays/s; "
                      f"copy of the moved scene {far['upload_ms']:.3f} ms, in all with the picture's way back {far['wall_ms']:.1f} ms; "
                      f"best peer {peer} ms (far)")


ALL = {card_rate: 60}
