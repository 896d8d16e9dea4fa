"""What 64 clients that never read cost the thread that steps, and how much memory they take.

    python3 tests/fetch_data.py; python3 bench/stuck_clients.py [SCENE] [--seconds N] [--pairs N] [--speed N] [--half-open]

One live run with ZeroMQ and Foxglove, in real time times N; phases without clients and with them in turn: 16 connections to each
server that stop in the middle of the handshake, 16 subscribers of each that read nothing of states, joints and transforms. CPU time
of the busiest thread over the steps that it took. Prints JSON.
"""
import argparse
import json
import os
import re
import signal
import socket
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
for folder in ("tests", "tests/e2e", "python"):
    sys.path.insert(0, str(ROOT / folder))
import fetch_data  # noqa: E402

sys.path.insert(0, str(fetch_data.packages(fetch_data.default_folder())))
import zmq  # noqa: E402
from foxglove_client import FoxgloveClient  # noqa: E402
from gloam_zmq import Client  # noqa: E402

PROGRAM = ROOT / "build" / "release" / "bin" / "gloam"
TOKEN = "a-token-of-the-bench"
EACH = 16


def threads(pid):
    """CPU time of each thread [s]."""
    return {stat.parent.name: int(stat.read_text().split()[0]) * 1e-9 for stat in Path(f"/proc/{pid}/task").glob("*/schedstat")}


def memory(pid):
    """Resident memory [MB]."""
    return int(re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{pid}/status").read_text())[1]) / 1024


class Stuck:
    """64 clients; closed by leaving."""

    def __init__(self, zmq_port, foxglove_port, joints, subscribes):
        self.context, self.open = zmq.Context(), []
        for port, words in ((zmq_port, b"\xff\x00\x00"), (foxglove_port, b"GET / HTTP/1.1\r\nHost: 127.0")):
            for _ in range(EACH):
                half = socket.create_connection(("127.0.0.1", port))
                half.sendall(words)
                self.open.append(half)
        for _ in range(EACH if subscribes else 0):
            subscriber = self.context.socket(zmq.SUB)
            subscriber.setsockopt(zmq.LINGER, 0)
            subscriber.setsockopt(zmq.RCVHWM, 10)
            subscriber.setsockopt(zmq.RCVBUF, 4096)
            for topic in (b"state", b"/tf", joints.encode()):
                subscriber.setsockopt(zmq.SUBSCRIBE, topic)
            subscriber.connect(f"tcp://127.0.0.1:{zmq_port + 1}")
            self.open.append(subscriber)
        for _ in range(EACH if subscribes else 0):
            watcher = FoxgloveClient(f"ws://127.0.0.1:{foxglove_port}/?token={TOKEN}")
            for topic in ("/tf", joints):
                watcher.subscribe(topic)
            self.open.append(watcher)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for client in self.open:
            client.close()
        self.context.term()


def free_port():
    """The first of two that are free."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def phase(sim, pid, thread, seconds):
    """CPU time of a step [µs]."""
    first, cpu = sim.state()["step"], threads(pid)[thread]
    time.sleep(seconds)
    return 1e6 * (threads(pid)[thread] - cpu) / (sim.state()["step"] - first)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default=ROOT / "examples" / "two_robots.toml", type=Path)
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--pairs", type=int, default=4)
    parser.add_argument("--speed", type=float, default=1)
    parser.add_argument("--half-open", action="store_true", help="only the 32 connections that stop in the handshake")
    arguments = parser.parse_args()
    zmq_port, foxglove_port = free_port(), free_port()
    command = [PROGRAM, "run", arguments.scene, "--zmq", "--foxglove", "--speed", arguments.speed,
               "--set", f"bridge.zmq.port={zmq_port}", "--set", f"bridge.foxglove.port={foxglove_port}"]
    process = subprocess.Popen([str(word) for word in command], env={**os.environ, "GLOAM_TOKEN": TOKEN}, stderr=subprocess.PIPE, text=True)
    try:
        next(line for line in process.stderr if "running" in line)
        with Client(f"tcp://127.0.0.1:{zmq_port}", token=TOKEN) as sim:
            joints = next(t["name"] for t in sim.topics() if t["type"] == "sensor_msgs/msg/JointState" and not t["input"])
            before = threads(process.pid)
            time.sleep(2)
            after = threads(process.pid)
            thread = max(after, key=lambda t: after[t] - before.get(t, 0))
            start, ratios, largest = memory(process.pid), [], 0
            for _ in range(arguments.pairs):
                alone = phase(sim, process.pid, thread, arguments.seconds)
                with Stuck(zmq_port, foxglove_port, joints, not arguments.half_open):
                    time.sleep(1)
                    beside = phase(sim, process.pid, thread, arguments.seconds)
                    largest = max(largest, memory(process.pid))
                ratios.append(beside / alone)
                time.sleep(3)  # streams end
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(timeout=60)
    print(json.dumps({"clients": (2 if arguments.half_open else 4) * EACH, "cost": statistics.median(ratios) - 1, "pairs": [round(r, 4) for r in ratios], "step_us": round(alone, 2),
                      "memory_mb": [round(start), round(largest)]}))


if __name__ == "__main__":
    main()
