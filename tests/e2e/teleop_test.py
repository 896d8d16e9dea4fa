"""Driving by hand: `gloam run --teleop` at a pseudo-terminal, as in a shell, and with a gamepad."""
import contextlib
import fcntl
import json
import os
import pty
import re
import signal
import struct
import subprocess
import termios
import threading
import time
import unittest

from e2e.support import PROGRAM, ProgramTest

BASE = """<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
  <geom type="plane" size="9 9 1" friction="1"/>
  <body name="base" pos="0 0 .07"><freejoint/><geom type="box" size=".15 .1 .03" mass="5"/>
    <geom type="sphere" size=".02" pos="-.13 0 -.05" condim="1" priority="1" mass=".05"/>
    <geom type="sphere" size=".02" pos=".13 0 -.05" condim="1" priority="1" mass=".05"/>
    <body name="wl" pos="0 .15 0"><joint name="l" axis="0 1 0"/><geom type="cylinder" size=".07 .01" euler="90 0 0" mass=".3"/></body>
    <body name="wr" pos="0 -.15 0"><joint name="r" axis="0 1 0"/><geom type="cylinder" size=".07 .01" euler="90 0 0" mass=".3"/></body>
  </body></worldbody><actuator><velocity joint="l" kv="3"/><velocity joint="r" kv="3"/></actuator></mujoco>
"""
SCENE = """[[robot]]
name = "base"
file = "base.xml"
[robot.controller]
type = "diff_drive"
"""
AHEAD = struct.pack("<IhBB", 0, -32767, 2, 1)  # js_event: axis 1, the left stick, up


class Session:
    """A program at a terminal of its own; everything that it prints is collected."""

    def __init__(self, arguments, folder, columns=100):
        self.pid, self.master = pty.fork()
        if self.pid == 0:
            os.chdir(folder)
            for number in (signal.SIGINT, signal.SIGQUIT, signal.SIGTSTP):
                signal.signal(number, signal.SIG_DFL)  # a shell may have started the tests with them ignored
            os.execvpe(arguments[0], list(map(str, arguments)),
                       {**os.environ, "GLOAM_CACHE": str(folder / "cache"), "TERM": "xterm", "PS1": "$ "})
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        self.text, self.code = "", None
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        with contextlib.suppress(OSError):  # EIO: the program has ended
            while data := os.read(self.master, 4096):
                self.text += data.decode(errors="replace")

    def press(self, keys):
        os.write(self.master, keys.encode())

    def hold(self, key, seconds):
        """As a terminal repeats it."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.press(key)
            time.sleep(0.03)

    def wait_for(self, pattern, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if found := re.search(pattern, self.text):
                return found
            time.sleep(0.02)
        raise AssertionError(f"no {pattern!r} in {self.text[-600:]!r}")

    def forget(self):
        self.text = ""

    def wait(self, seconds=30):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.code = os.waitstatus_to_exitcode(status)
                return self.code
            time.sleep(0.02)
        raise AssertionError(f"it does not end: {self.text[-600:]!r}")

    def close(self):
        if self.code is None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self.pid, signal.SIGKILL)
            with contextlib.suppress(ChildProcessError):
                os.waitpid(self.pid, 0)
        os.close(self.master)


class Teleop(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("base.xml", BASE)
        self.scene = self.write("base.toml", SCENE)

    def session(self, *arguments, columns=100):
        session = Session(arguments, self.folder, columns)
        self.addCleanup(session.close)
        return session

    def run_teleop(self, *extra, columns=100):
        session = self.session(PROGRAM, "run", self.scene, "--teleop", *extra, columns=columns)
        session.mode = termios.tcgetattr(session.master)
        session.wait_for("base: vx")
        self.assertNotEqual(termios.tcgetattr(session.master)[3], session.mode[3], "the terminal is not switched")
        return session

    def assert_restored(self, session):
        self.assertEqual(termios.tcgetattr(session.master), session.mode)

    def positions(self, log):
        """Times [s] and positions along x [m] of the base in a log."""
        self.gloam("export", log, "--to", "tum", "--topic", "/base/odom", "--out", self.folder / "odom.tum")
        rows = [line.split() for line in (self.folder / "odom.tum").read_text().splitlines() if not line.startswith("#")]
        return [(float(row[0]), float(row[1])) for row in rows]

    def test_drive_stop_end_and_verify(self):
        session = self.run_teleop("--mcap", "--out", "out")
        self.assertIn("Keys drive robot 'base'", session.text)
        session.press("9")
        session.hold("w", 1.5)
        session.wait_for(r"vx \+1\.00 m/s")
        session.forget()
        session.wait_for(r"vx \+0\.00 m/s", 3)
        time.sleep(1.5)  # it brakes with 1 m/s2
        session.press("\x1b")
        self.assertEqual(session.wait(), 0)
        self.assert_restored(session)
        log = self.folder / "out" / "run.mcap"
        positions = self.positions(log)
        self.assertGreater(positions[-1][1], 0.8)
        self.assertLess(max(abs(x - positions[-1][1]) for time_s, x in positions if time_s > positions[-1][0] - 0.3), 0.01, "it stands at the end")
        topics = {topic["name"]: topic["messages"] for topic in json.loads(self.gloam("info", log, "--json").stdout)["topics"]}
        self.assertEqual(topics["/base/cmd_vel"], 2, "of 50 key repeats, one goal and its end")
        self.assertRegex(self.gloam("replay", log, "--verify").stdout, r"^0 of \d+ steps differ")

    def test_signals_restore_the_terminal(self):
        for key, number in (("\x03", None), (None, signal.SIGTERM)):
            session = self.run_teleop()
            session.press("w")
            session.press(key) if key else os.kill(session.pid, number)
            self.assertEqual(session.wait(), 0, session.text)
            self.assert_restored(session)

    def test_a_crash_restores_the_terminal(self):
        for number in (signal.SIGSEGV, signal.SIGQUIT):
            session = self.run_teleop()
            os.kill(session.pid, number)
            self.assertEqual(session.wait(), -number)
            self.assert_restored(session)

    def test_suspension_and_return(self):
        shell = self.session("bash", "--norc", "-i")
        shell.press(f"{PROGRAM} run base.toml --teleop\r")
        shell.wait_for("real time")
        raw = termios.tcgetattr(shell.master)[3]
        shell.press("\x1a")
        shell.wait_for("Stopped")
        shell.forget()
        shell.press("stty -a\r")
        self.assertNotIn("-icanon", shell.wait_for(r"(?s)icanon.*echo\b.*\$ ").string)
        shell.forget()
        shell.press("fg\r")
        shell.wait_for("real time")
        self.assertEqual(termios.tcgetattr(shell.master)[3], raw)
        shell.hold("w", 0.4)
        shell.wait_for(r"vx \+0\.56 m/s")
        shell.press("\x03")
        shell.wait_for(r"\$ $")

    def test_a_gamepad_comes_and_goes(self):
        pad = self.folder / "pad"
        os.mkfifo(pad)
        session = self.run_teleop("--gamepad", "pad")
        for _ in range(2):
            session.forget()
            with open(pad, "wb", buffering=0) as device:
                device.write(AHEAD[:3])
                time.sleep(0.1)
                device.write(AHEAD[3:] + bytes(range(256)) * 8)
                session.wait_for("gamepad: pad")
                session.wait_for(r"vx \+0\.56 m/s")
            session.wait_for("unplugged, the robot stops")
            session.wait_for(r"vx \+0\.00 m/s")
            time.sleep(1.2)
        session.press("\x03")
        self.assertEqual(session.wait(), 0)

    def test_the_status_fits_into_a_narrow_terminal(self):
        session = self.run_teleop(columns=30)
        session.press("\x03")
        self.assertEqual(session.wait(), 0)
        lines = re.findall(r"base: vx[^\r\x1b]*", session.text)
        self.assertTrue(lines)
        self.assertEqual({len(line) for line in lines}, {29})

    def test_errors(self):
        self.assertIn("not a terminal", self.gloam("run", self.scene, "--teleop", expect=2).stderr)
        arm = self.write("arm.toml", SCENE.replace("diff_drive", "joint_velocity"))
        for arguments, words in (((self.scene, "--teleop", "bose"), "did you mean 'base'"), ((arm, "--teleop"), "'joint_velocity'.*diff_drive"),
                                 ((self.scene, "--teleop", "--gamepad", "/dev/null"), "not a joystick"),
                                 ((self.scene, "--gamepad", "pad"), "--teleop")):
            session = self.session(PROGRAM, "run", *arguments)
            session.wait_for(f"(?s)gloam: error: .*{words}")
            self.assertIn(session.wait(), (1, 2))

    def test_the_help_of_the_command_shows_it(self):
        text = subprocess.run([str(PROGRAM), "run", "--help"], capture_output=True, text=True, check=True).stdout
        self.assertIn("--teleop [ROBOT]", text)
        self.assertIn("--gamepad DEVICE", text)


if __name__ == "__main__":
    unittest.main()
