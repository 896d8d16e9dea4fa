"""A log of ours is opened by Rerun: its MCAP loader finds no fault and has all topics."""
import json
import os
import subprocess
import unittest

import fetch_data
from e2e.support import ROOT, ProgramTest

RERUN = fetch_data.packages(fetch_data.default_folder()) / "rerun_cli" / "rerun"


@unittest.skipUnless(RERUN.exists(), "the packages of the tests are not here: tests/fetch_data.py")
class Rerun(ProgramTest):
    def rerun(self, *arguments):
        home = self.folder / "home"  # its settings; without them it would ask whether it may count what is used
        home.mkdir(exist_ok=True)
        own = {name: value for name, value in os.environ.items() if not name.startswith("XDG_")}
        command = [str(RERUN) if RERUN.stat().st_mode & 0o100 else self.runnable()]
        result = subprocess.run([*command, *map(str, arguments)], env=own | {"HOME": str(home)}, cwd=self.folder, text=True,
                                capture_output=True, timeout=300)
        self.assertEqual(result.returncode, 0, f"rerun {arguments}\n{result.stdout}{result.stderr}")
        return result.stdout + result.stderr

    def runnable(self):
        link = self.folder / "rerun"
        if not link.exists():
            link.write_bytes(RERUN.read_bytes())
            link.chmod(0o700)
        return str(link)

    def test_a_log_is_sound_and_converted_topic_by_topic(self):
        self.gloam("record", ROOT / "examples/two_robots.toml", "-o", "run.mcap", "--duration", "0.5", "--topics", "*", "--tier", "direct", "--spp",
                   "1", "--resolution", "64x48")
        self.rerun("analytics", "disable")
        topics = [t["name"] for t in json.loads(self.gloam("info", "run.mcap", "--json").stdout)["topics"] if t["messages"] > 0]
        checked = self.rerun("mcap", "check", "run.mcap", "--full")
        self.assertNotRegex(checked, r"(?im)^(error|warn)")
        self.rerun("mcap", "convert", "run.mcap", "-o", "run.rrd")
        stats = self.rerun("rrd", "stats", "run.rrd")
        for topic in topics:
            self.assertIn(f"\n{topic}: ", stats)


if __name__ == "__main__":
    unittest.main()
