"""Clients of ZeroMQ without a token that flood a server and then reset their connections: nothing they do ends a simulation."""
import os
import random
import signal
import socket
import struct
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from e2e.support import PENDULUM, PROGRAM

SCENE = '[environment]\nfile = "place.xml"\n[[robot]]\nname = "arm"\nfile = "arm.xml"\n[robot.controller]\ntype = "none"\n'
PLACE = '<mujoco><worldbody><light pos="0 0 3"/><geom type="plane" size="2 2 .1"/></worldbody></mujoco>'
# ZMTP 3.0 (rfc.zeromq.org/spec/23): greeting with the mechanism NULL, then READY.
GREETING = b"\xff" + b"\0" * 8 + b"\x7f\3\0NULL" + b"\0" * 16 + b"\0" + b"\0" * 31
READY = b"\x05READY\x0bSocket-Type\0\0\0\6DEALER"


def frame(body, flags=0):
    if len(body) < 256:
        return bytes([flags, len(body)]) + body
    return bytes([flags | 2]) + struct.pack(">Q", len(body)) + body


class Dealer:
    """One raw connection to a ROUTER."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.socket.sendall(GREETING + frame(READY, flags=4))
        self.socket.settimeout(0.3)
        time.sleep(0.05)  # what follows a handshake too closely makes libzmq close the connection

    def flood(self, body, seconds):
        """Sends until the server reads no more; returns the number of whole requests."""
        request, sent, end = frame(body), 0, time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                sent += self.socket.send(memoryview(request)[sent % len(request):])
            except OSError:  # it reads no more, or has closed the connection
                break
        return sent // len(request)

    def reset(self):
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.socket.close()

    def ask(self, body):
        """Sends a request and returns the bytes that come until it is silent."""
        self.socket.sendall(frame(body))
        came = b""
        end = time.monotonic() + 10
        while time.monotonic() < end and b"result" not in came and b"error" not in came:
            try:
                came += self.socket.recv(65536)
            except socket.timeout:
                pass
        return came


class Attacks(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="gloam_attack_")
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        for name, text in (("arm.toml", SCENE), ("arm.xml", PENDULUM), ("place.xml", PLACE)):
            (self.folder / name).write_text(text)
        for self.port in random.sample(range(20000, 32000), 20):
            self.server = subprocess.Popen([str(PROGRAM), "run", "arm.toml", "--zmq", "--set", f"bridge.zmq.port={self.port}"], cwd=self.folder,
                                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                           env={**os.environ, "XDG_RUNTIME_DIR": str(self.folder)})
            self.addCleanup(self.server.stderr.close)
            self.addCleanup(self.server.kill)
            end = time.monotonic() + 60
            while not list(self.folder.glob("gloam/zmq-*.json")) and self.server.poll() is None and time.monotonic() < end:
                time.sleep(0.05)
            if self.server.poll() is None:
                return
        self.fail(self.server.stderr.read())

    def check_alive(self):
        self.assertIsNone(self.server.poll(), "the simulation has ended")
        hello = Dealer(self.port)
        self.assertIn(b"result", hello.ask(b"\x81\xa2op\xa5hello"))
        hello.socket.close()

    def finish(self):
        self.server.send_signal(signal.SIGINT)
        self.assertEqual(self.server.wait(30), 0)

    def test_floods_that_end_in_a_reset(self):
        """libzmq's heartbeat timer asserted on connections that were reset while their input was stopped (libzmq 4364)."""
        nils = b"\xdd" + struct.pack(">I", 100000) + b"\xc0" * 100000
        unanswered = b"\x83\xa2op\xa5pause\xa2id\x01\xa5token\xa3bad"
        for body in (nils, unanswered):
            clients = [Dealer(self.port) for _ in range(8)]
            for client in clients:
                self.assertGreater(client.flood(body, 0.3), 0)
            for client in clients[:4]:
                client.reset()
            time.sleep(1.5)  # the heartbeat came once a second
            for client in clients[4:]:
                client.flood(body, 0.1)
                client.reset()
            time.sleep(1.5)
            self.check_alive()
        self.finish()

    def test_long_requests_without_a_token_take_no_memory(self):
        def memory():
            status = Path(f"/proc/{self.server.pid}/status").read_text()
            return int(status.split("VmHWM:")[1].split()[0]) / 1024
        before = memory()
        client = Dealer(self.port)
        body = b"\x83\xa2op\xa4ping\xa5token\xa3bad\xa4args\xdd" + struct.pack(">I", 10_000_000) + b"\xc0" * 10_000_000
        client.socket.settimeout(20)
        for _ in range(5):
            self.assertIn(b"token", client.ask(body))
        client.socket.close()
        # 10 million values of msgpack are 240 MB when they are made.
        self.assertLess(memory() - before, 150)
        self.check_alive()
        self.finish()


if __name__ == "__main__":
    unittest.main()
