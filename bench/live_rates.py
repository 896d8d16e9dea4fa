"""Rates at which the sensors of a live run come while one large camera renders beside them.

    python3 tests/fetch_data.py
    python3 bench/live_rates.py [--place house] [--program FILE] [--seconds N] [--tier path] [--spp N] [--pace realtime]

The demo's room, or a generated house, with a quadruped: joint states, an IMU, a LiDAR of 16 rings at 10 Hz, a camera of
64x64 at 10 Hz, and then a camera of 640x480 at 10 Hz as well. Each phase is one live run whose topics a client of
ZeroMQ counts, by simulation time; the program runs on two processors. Prints a table, with --json JSON. Another build's
program (--program) gives the rates before a change.
"""
import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
for folder in ("tests", "python"):
    sys.path.insert(0, str(ROOT / folder))
import fetch_data  # noqa: E402

sys.path.insert(0, str(fetch_data.packages(fetch_data.default_folder())))
import msgpack  # noqa: E402
import zmq  # noqa: E402
from gloam_zmq import Client  # noqa: E402

SCENE = """
[scene]
name = "rates"
{place}
[[robot]]
name = "quadruped"
file = "{assets}/robots/quadruped/quadruped.xml"
position = {start}
keyframe = "home"
[robot.controller]
type = "trot"
goals = [{{ time = 0.3, vx = 0.3, yaw_rate = 0.6 }}]
[[lidar]]
name = "back"
body = "quadruped/trunk"
position = [0, 0, 0.12]
preset = "VLP-16"
columns = 900
[[camera]]
name = "small"
track = "quadruped/trunk"
position = [1.5, -0.75, 0.7]
look_at = [0, 0, 0]
width = 64
height = 64
rate = 10
[[camera]]
name = "large"
track = "quadruped/trunk"
position = [-1.5, -0.75, 0.7]
look_at = [0.3, 0.15, -0.05]
width = 640
height = 480
rate = 10
[bridge.zmq]
port = 0
"""
PLACES = {"room": ('[environment]\nfile = "{assets}/environments/room/room.xml"', [-1.0, -0.5, 0]),
          "house": ("[environment]\nhouse = {{}}", [4, 1.5, 0])}  # in its living room


def topics_of(sim, large):
    """{name: (topic, wanted rate)} of the sensors in the scene."""
    found = {}
    for topic in sim.topics():
        name = topic["name"]
        for part in ("joint_states", "imu", "back/points", "small/image_raw") + (("large/image_raw",) if large else ()):
            if name.endswith(part) and not topic["input"]:
                found[part] = (name, topic["rate"])
    return found


def count(sim, topics, seconds):
    """Messages of each topic and the first and last simulation time, over wall seconds."""
    socket = zmq.Context.instance().socket(zmq.SUB)
    socket.setsockopt(zmq.RCVHWM, 10000)
    host = sim.address.rsplit(":", 1)[0]
    socket.connect(f"{host}:{sim.hello()['streams'].rsplit(':', 1)[1]}")
    for name, _ in topics.values():
        socket.subscribe(name.encode())
    time.sleep(4)  # the first pictures fill caches
    while socket.poll(0):
        socket.recv_multipart()
    counts, begin, first, last = {name: 0 for name, _ in topics.values()}, time.monotonic(), sim.state()["time"], 0
    while time.monotonic() < begin + seconds:
        if not socket.poll(100):
            continue
        frames = socket.recv_multipart()
        name = frames[0].decode()
        if name in counts and msgpack.unpackb(frames[1])["type"] != "error":
            counts[name] += 1
    last = sim.state()["time"]
    wall = time.monotonic() - begin
    socket.close(0)
    return counts, last - first, wall


def phase(options, folder, large):
    runtime = Path(folder) / ("large" if large else "small")
    runtime.mkdir(mode=0o700)
    scene = runtime / "rates.toml"
    place, start = PLACES[options.place]
    scene.write_text(SCENE.format(assets=ROOT / "assets", place=place.format(assets=ROOT / "assets"), start=start))
    command = [options.program, "run", str(scene), "--zmq", "--tier", options.tier, "--spp", str(options.spp), "--threads", "2", "--root", str(ROOT)]
    command += ["--pace", options.pace] if options.pace != "realtime" else []
    command = (["taskset", "-c", "0,1"] if os.cpu_count() > 2 else []) + command
    env = {**os.environ, "XDG_RUNTIME_DIR": str(runtime)}
    server = subprocess.Popen(command, cwd=runtime, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        end = time.monotonic() + 120
        while not list(runtime.glob("gloam/zmq-*.json")):
            if server.poll() is not None or time.monotonic() > end:
                raise SystemExit(f"the server did not start: {server.stderr.read()}")
            time.sleep(0.1)
        os.environ["XDG_RUNTIME_DIR"] = str(runtime)
        with Client(timeout=60) as sim:
            topics = topics_of(sim, large)
            counts, simulated, wall = count(sim, topics, options.seconds)
            state = sim.state()
    finally:
        server.send_signal(signal.SIGINT)
        table = server.communicate(timeout=180)[1]
    rates = {part: {"wanted_hz": rate, "achieved_hz": round(counts[name] / simulated, 2), "per_wall_second": round(counts[name] / wall, 2)}
             for part, (name, rate) in topics.items()}
    return {"realtime_factor": round(simulated / wall, 3), "rates": rates, "sensors": state.get("sensors"), "said": table}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build" / "release" / "bin" / "gloam"))
    parser.add_argument("--place", choices=PLACES, default="room")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--tier", default="path")
    parser.add_argument("--spp", type=int, default=4)
    parser.add_argument("--pace", default="realtime")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="gloam_rates_", dir=ROOT / "build") as folder:
        results = {name: phase(options, folder, name == "with a 640x480 camera") for name in ("without", "with a 640x480 camera")}
    if options.json:
        print(json.dumps(results, indent=2))
        return
    for name, result in results.items():
        print(f"{name}: {result['realtime_factor']} of real time")
        for part, rate in result["rates"].items():
            print(f"  {part:<18} wanted {rate['wanted_hz']:6.1f} Hz   got {rate['achieved_hz']:6.2f} Hz   {rate['per_wall_second']:6.2f} a wall second")
        print(result["said"].strip())


if __name__ == "__main__":
    main()
