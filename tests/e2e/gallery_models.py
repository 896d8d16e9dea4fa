"""The first look at every robot of the test packages: `./gloam gallery --models`, all of it (in ./gloam test full)."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import fetch_data
from e2e.support import ROOT

sys.path.insert(0, str(ROOT / "tools" / "gallery"))
import models  # noqa: E402


class FirstLook(unittest.TestCase):
    def test_95_of_100_models_are_seen_well(self):
        with tempfile.TemporaryDirectory(prefix="models_", dir=ROOT / "build") as folder:
            done = subprocess.run([ROOT / "gloam", "gallery", "--models", fetch_data.default_folder(), "--out", folder],
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            results = json.loads((Path(folder) / "models.json").read_text())
        shown = {name: list(models.faults(r)) for name, r in results.items() if "picture" in r}
        self.assertGreater(len(shown), 50)
        faulty = {name: faults for name, faults in shown.items() if faults}
        self.assertLessEqual(len(faulty), 0.05 * len(shown), faulty)


if __name__ == "__main__":
    unittest.main()
