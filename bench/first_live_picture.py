"""Seconds from a client's first byte to the first picture of the live page, 320x240: bench/first_live_picture.py [SCENE] [TIER ...]

Asked is 3 s on an idle machine. Example: python3 bench/first_live_picture.py examples/house.toml interactive path
"""
import base64
import os
import re
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def first_picture(scene, tier):
    """Seconds until the first binary message of the page's WebSocket."""
    program = subprocess.Popen([ROOT / "build" / "release" / "bin" / "gloam", "run", scene, "--view", "--port", "0", "--resolution", "320x240",
                                "--tier", tier], stderr=subprocess.PIPE, text=True, stdout=subprocess.DEVNULL)
    try:
        found = next(filter(None, (re.search(r"http://127\.0\.0\.1:(\d+)/\?token=(\w+)", line) for line in program.stderr)))
        port, token = found.groups()
        start = time.monotonic()
        with socket.create_connection(("127.0.0.1", int(port)), 60) as client, client.makefile("rb") as stream:
            key = base64.b64encode(os.urandom(16)).decode()
            client.sendall(f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: token {token}\r\nUpgrade: websocket\r\n"
                           f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
            while stream.readline() not in (b"\r\n", b""):
                pass
            while True:
                kind, size = stream.read(2)
                if size & 127 > 125:
                    size = int.from_bytes(stream.read(2 if size & 127 == 126 else 8), "big")
                stream.read(size)
                if kind & 15 == 2:
                    return time.monotonic() - start
    finally:
        program.send_signal(signal.SIGINT)
        program.wait(60)


if __name__ == "__main__":
    scene_file = sys.argv[1] if len(sys.argv) > 1 else ROOT / "examples" / "house.toml"
    for each in sys.argv[2:] or ["interactive", "path"]:
        print(f"{Path(scene_file).name}, {each} tier: first picture after {first_picture(scene_file, each):.2f} s")
