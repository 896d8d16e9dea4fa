"""docs/extending.md names files that exist, and recipes cost what they say."""
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = (ROOT / "docs" / "extending.md").read_text()
# Shared files that an effect, as others know them, may not be named in.
NO_EFFECT_NAMED = ["src/sim/loop/stepper.h", "src/sim/loop/stepper.cc", "src/sim/snapshots/snapshot.h", "src/sim/snapshots/pose_solver.cc",
                   "src/sim/loop/sim_loop.cc", "include/gloam/controller.h"]


class Extending(unittest.TestCase):
    def test_files_exist(self):
        for name in re.findall(r"`((?:src|include|examples|tests)/[\w./]+)`", PAGE):
            self.assertTrue((ROOT / name).exists(), name)

    def test_the_step_loop_names_no_effect(self):
        effects = re.compile(r'#include "sim/(agents|effects/(gas|soil|water|wind|dust))/')
        for name in NO_EFFECT_NAMED:
            self.assertEqual(effects.findall((ROOT / name).read_text()), [], name)

    def test_an_effect_is_one_line_of_its_list(self):
        users = [str(p.relative_to(ROOT)) for p in (ROOT / "src/sim").rglob("*.cc")
                 if "/test/" not in str(p) and "WaterEffect::make" in p.read_text()]
        self.assertEqual(sorted(users), ["src/sim/effects/effect_list.cc", "src/sim/effects/water/water_effect.cc"])

    def test_a_controller_costs_two_lines_elsewhere(self):
        users = [str(p.relative_to(ROOT)) for p in (ROOT / "src").rglob("*.cc") if "/test/" not in str(p) and '"gripper"' in p.read_text()]
        self.assertEqual(sorted(users), ["src/control/controllers.cc", "src/scene/options/controller_types.cc"])


if __name__ == "__main__":
    unittest.main()
