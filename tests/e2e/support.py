"""What the end-to-end tests share: running the program as a user does."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build" / "release" / "bin" / "gloam"

PENDULUM = """<mujoco model="pendulum">
  <worldbody>
    <light pos="0 0 3"/>
    <geom name="floor" type="plane" size="2 2 0.1"/>
    <body name="arm" pos="0 0 1">
      <joint name="hinge" axis="0 1 0"/>
      <geom name="rod" type="capsule" fromto="0 0 0 0.3 0 0" size="0.02" rgba="0.8 0.2 0.2 1"/>
    </body>
    <camera name="side" pos="0 -2 1" xyaxes="1 0 0 0 0 1"/>
  </worldbody>
  <actuator><motor name="motor" joint="hinge" ctrlrange="-1 1"/></actuator>
</mujoco>
"""


def video_frames(path):
    """Frames that a stranger's decoder finds in a video; fails on damaged ones."""
    result = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v:0", "-count_frames", "-show_entries", "stream=nb_read_frames",
                             "-of", "csv=p=0", str(path)], capture_output=True, text=True)
    if result.returncode != 0 or result.stderr:
        raise AssertionError(f"{path} is damaged: {result.stderr}")
    return int(result.stdout.strip().strip(","))


class ProgramTest(unittest.TestCase):
    """A test with a scratch folder and a cache of its own."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="gloam_e2e_")
        self.folder = Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def gloam(self, *arguments, expect=0, timeout=120, env=None, cwd=None, preexec_fn=None):
        """Runs the program; asserts its exit code and that no crash text appears."""
        result = subprocess.run([str(PROGRAM), *map(str, arguments)], cwd=cwd or self.folder, text=True, capture_output=True,
                                stdin=subprocess.DEVNULL, timeout=timeout, preexec_fn=preexec_fn,
                                env={**os.environ, "GLOAM_CACHE": str(self.folder / "cache"), **(env or {})})
        self.assertEqual(result.returncode, expect, f"gloam {' '.join(map(str, arguments))}\nstdout: {result.stdout}\nstderr: {result.stderr}")
        return result
