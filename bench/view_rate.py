"""How fast the studio is: a client of docs/view_protocol.md that answers each image with `seen`.

    python3 bench/view_rate.py [SCENE] [CAMERA]     default: examples/house.toml, its first camera

prints the seconds to the first image, the images per second at 640x480, and how soon the state shows the effect of a
request. Run it on an idle machine.
"""
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import time
from base64 import b64encode
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
REQUESTS = 100


class Client:
    """A WebSocket of RFC 6455 as far as the view's protocol needs it."""

    def __init__(self, port, token):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        self.socket.sendall((f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: token {token}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {b64encode(os.urandom(16)).decode()}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self.reader = self.socket.makefile("rb")
        status = self.reader.readline().decode()
        if " 101 " not in status:
            raise RuntimeError(f"the view refuses: {status.strip()}")
        while self.reader.readline() not in (b"\r\n", b""):
            pass

    def send(self, **message):
        text = json.dumps(message).encode()
        mask = os.urandom(4)
        self.socket.sendall(bytes([0x81]) + (bytes([0x80 | len(text)]) if len(text) < 126 else struct.pack(">BH", 0xFE, len(text))) + mask +
                            bytes(b ^ mask[i % 4] for i, b in enumerate(text)))

    def message(self):
        """The next text (a dict) or picture (bytes)."""
        while True:
            first, length = self.reader.read(2)
            if length == 126:
                length = struct.unpack(">H", self.reader.read(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self.reader.read(8))[0]
            payload = self.reader.read(length)
            if first & 15 == 1:
                return json.loads(payload)
            if first & 15 == 2:
                return payload

    def state_where(self, holds):
        """The next state that satisfies a condition; pictures are acknowledged meanwhile."""
        while True:
            message = self.message()
            if isinstance(message, bytes):
                self.send(type="seen")
            elif message["type"] == "state" and holds(message):
                return message

    def pictures(self, seconds):
        """Arrival times and widths of the pictures of so many seconds."""
        out, end = [], time.monotonic() + seconds
        while time.monotonic() < end:
            message = self.message()
            if isinstance(message, bytes):
                out.append((time.monotonic(), struct.unpack_from("<H", message, 32)[0]))
                self.send(type="seen")
        return out


def request_times(client):
    """Sorted seconds from requests to the states that show their effects."""
    times = []
    for i in range(REQUESTS):
        wanted = 0.5 if i % 2 else 1
        start = time.monotonic()
        client.send(type="speed", value=wanted)
        client.state_where(lambda state: state["speed"] == wanted)
        times.append(time.monotonic() - start)
    return sorted(times)


def watch(program, scene, camera, seconds):
    """{"first": seconds from a client's coming to its first picture, "rate": pictures per second of the running simulation, "width",
    "still": pictures of the paused one in as many seconds, "still_width", "request": seconds within which 95 % of requests show in the
    state}. camera: "" = the scene's first."""
    command = [program, "run", scene, "--view", "--port", "0", "--resolution", "640x480", "--duration", "3600"]
    command += ["--camera", camera] if camera else []
    with subprocess.Popen([str(word) for word in command], stderr=subprocess.PIPE, text=True) as process:
        try:
            found = next(match for line in process.stderr if (match := re.search(r":(\d+)/\?token=(\w+)", line)))
            start = time.monotonic()
            client = Client(int(found[1]), found[2])
            while not isinstance(client.message(), bytes):
                pass
            first = time.monotonic() - start
            client.send(type="seen")
            client.send(type="claim")
            client.send(type="resume")
            client.pictures(4)  # until the resolution has settled
            moving = client.pictures(seconds)
            request = request_times(client)[REQUESTS * 95 // 100]
            client.send(type="pause")
            client.pictures(1)
            still = client.pictures(seconds)
        finally:
            process.send_signal(signal.SIGINT)
            process.stderr.close()
            process.wait(30)
    return {"first": first, "rate": len(moving) / seconds, "width": moving[-1][1] if moving else 0, "still": len(still), "still_width": still[-1][1] if still else 0,
            "request": request}


def main(scene, camera):
    found = watch(ROOT / "build" / "release" / "bin" / "gloam", scene, camera, 20)
    print(f"{Path(scene).name}: first image after {found['first']:.2f} s (3)")
    print(f"{Path(scene).name}: {found['rate']:.1f} images/s at 640x480 (10), {found['width']} px wide; paused: {found['still_width']} px")
    print(f"{Path(scene).name}: 95 % of requests show in the state within {1000 * found['request']:.0f} ms (100)")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else ROOT / "examples" / "house.toml", sys.argv[2] if len(sys.argv) > 2 else "")
