"""Of the full tier: each input of each scene that is scaled by 3 % is noticed against Mitsuba's stored pictures."""
import sys
import tempfile
import unittest
from pathlib import Path

from e2e.support import ROOT

sys.path.insert(0, str(ROOT / "bench" / "mitsuba"))
import agreement  # noqa: E402
import judge  # noqa: E402
import scenes  # noqa: E402


class Mutations(unittest.TestCase):
    def test_each_input_scaled_by_3_percent_is_noticed(self):
        with tempfile.TemporaryDirectory(prefix="gloam_e2e_") as folder:
            for name in scenes.ALL:
                for scaled in judge.scales_of(name)[0]:
                    with self.subTest(f"{name} {scaled}"):
                        _, ours, _ = judge.render(name, Path(folder), scaled)
                        found = agreement.compare(ours, judge.stored(name)[1][""])
                        self.assertFalse(found.agrees, str(found))
