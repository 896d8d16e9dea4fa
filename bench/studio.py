"""Measures the studio on this machine: bench/studio.py [SCENE]; default: examples/house.toml

Prints the seconds from a client's first byte to its first image (320×240), the images per second at 640×480 while the
simulation plays in real time, and the time from a request to the state that shows its effect (median and 95th
percentile of 100), each next to its bar. Run it on an idle machine.
"""
import base64
import contextlib
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SECONDS = 20  # of playing
EVENTS = 100


class Client:
    """A WebSocket that counts images and acknowledges them."""

    def __init__(self, port, token):
        self.images, self.widths = 0, {}
        self._socket = socket.create_connection(("127.0.0.1", int(port)), 60)
        self._stream = self._socket.makefile("rb")
        key = base64.b64encode(os.urandom(16)).decode()
        self._socket.sendall(f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: token {token}\r\nUpgrade: websocket\r\n"
                             f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        while self._stream.readline() not in (b"\r\n", b""):
            pass

    def send(self, **message):
        data = json.dumps(message).encode()
        mask = os.urandom(4)
        size = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + struct.pack(">H", len(data))
        self._socket.sendall(b"\x81" + size + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)))

    def receive(self):
        """The next text as an object, or None for an image."""
        kind, size = self._stream.read(2)
        if size & 127 > 125:
            size = int.from_bytes(self._stream.read(2 if size & 127 == 126 else 8), "big")
        data = self._stream.read(size)
        if kind & 15 == 1:
            return json.loads(data)
        if data[:4] == b"GLV1":
            self.images += 1
            width = struct.unpack_from("<H", data, 32)[0]
            self.widths[width] = self.widths.get(width, 0) + 1
            self.send(type="seen")
        return None

    def state_where(self, holds):
        while True:
            message = self.receive()
            if message and message["type"] == "state" and holds(message):
                return message


@contextlib.contextmanager
def studio(scene, *arguments):
    program = subprocess.Popen([ROOT / "build" / "release" / "bin" / "gloam", "studio", scene, "--no-browser", "--port", "0", *arguments],
                               stderr=subprocess.PIPE, text=True, stdout=subprocess.DEVNULL)
    try:
        found = next(filter(None, (re.search(r"http://127\.0\.0\.1:(\d+)/\?token=(\w+)", line) for line in program.stderr)))
        yield found.groups()
    finally:
        program.send_signal(signal.SIGINT)
        program.wait(60)


def first_image(scene):
    with studio(scene, "--resolution", "320x240") as address:
        start = time.monotonic()
        client = Client(*address)
        while client.images == 0:
            client.receive()
        return time.monotonic() - start


def playing(scene):
    """Images per second, their widths, and the real-time factor."""
    with studio(scene, "--resolution", "640x480", "--play") as address:
        client = Client(*address)
        state = client.state_where(lambda state: state["time"] > 5)  # the light cache is filled
        begin, client.images, client.widths = time.monotonic(), 0, {}
        while time.monotonic() - begin < SECONDS:
            state = client.receive() or state
        factor = client.state_where(lambda _: True)["realtime_factor"]
        return client.images / SECONDS, client.widths, factor


def event_times(scene):
    """Seconds from a request to the state that shows its effect."""
    times = []
    with studio(scene, "--resolution", "640x480", "--play") as address:
        client = Client(*address)
        client.state_where(lambda state: state["time"] > 3)
        for i in range(EVENTS):
            wanted = 0.5 if i % 2 else 1
            start = time.monotonic()
            client.send(type="speed", value=wanted)
            client.state_where(lambda state: state["speed"] == wanted)
            times.append(time.monotonic() - start)
            time.sleep(0.05)
    return sorted(times)


def main(scene):
    name = Path(scene).name
    print(f"{name}: first image after {first_image(scene):.2f} s (3)")
    rate, widths, factor = playing(scene)
    shown = ", ".join(f"{width} px: {count}" for width, count in sorted(widths.items()))
    print(f"{name}: {rate:.1f} images/s at 640×480 (10), real-time factor {factor:.2f}; widths of images: {shown}")
    times = event_times(scene)
    print(f"{name}: request to state {1000 * times[EVENTS // 2]:.0f} ms, 95 % within {1000 * times[EVENTS * 95 // 100]:.0f} ms (100)")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else ROOT / "examples" / "house.toml")
