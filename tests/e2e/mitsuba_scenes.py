"""The path tier against Mitsuba's stored pictures, and against closed forms: docs/mitsuba.md."""
import sys
import tempfile
import unittest
from pathlib import Path

from e2e.support import ROOT

sys.path.insert(0, str(ROOT / "bench" / "mitsuba"))
import agreement  # noqa: E402
import judge  # noqa: E402
import scenes  # noqa: E402


class Mitsuba(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="gloam_e2e_")
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def test_every_scene_agrees_and_every_mutation_is_noticed(self):
        for name in scenes.ALL:
            with self.subTest(name):
                _, ours, _ = judge.render(name, self.folder)
                _, estimates = judge.stored(name)
                for other, found in judge.judge(name, ours, estimates[""]).items():
                    self.assertTrue(found.agrees, f"{name} against {other}: {found}")
                    self.assertLess(max(found.ours, found.theirs), 0.01, "standard error of some block")
                self.assertEqual(judge.undetected(ours, estimates), [], "scaled by 3 %, and not noticed")

    def test_an_input_scaled_by_3_percent_is_noticed(self):
        for name, scaled in [("lamps_on_plane", "bulb"), ("diffuse", "red"), ("fuzz", "fuzz_color")]:
            _, ours, _ = judge.render(name, self.folder, scaled)
            found = agreement.compare(ours, judge.stored(name)[1][""])
            self.assertFalse(found.agrees, f"{name} with {scaled} scaled: {found}")

    def test_there_are_scenes_enough_and_each_has_its_mutations(self):
        self.assertGreaterEqual(len(scenes.ALL), 12)
        for name in scenes.ALL:
            inputs, lobes = judge.scales_of(name)
            self.assertEqual(sorted(judge.stored(name)[1]), sorted(["", *inputs, *lobes]), name)


class Agreement(unittest.TestCase):
    """The comparison itself, on numbers."""

    def pictures(self, seed, scale=1.0, spread=0.01, batches=32, where=range(108)):
        import random
        draw = random.Random(seed)
        return agreement.estimate([[draw.gauss(1, spread) * (scale if block in where else 1) for block in range(108) for _ in range(3)]
                                   for _ in range(batches)])

    def test_equal_pictures_agree(self):
        refused = [seed for seed in range(100) if not agreement.compare(self.pictures(2 * seed), self.pictures(2 * seed + 1)).agrees]
        self.assertLessEqual(len(refused), 2)

    def test_a_small_change_of_all_and_a_large_one_of_few_are_seen(self):
        for scale, where in [(1.001, range(108)), (1.03, range(6))]:
            self.assertFalse(agreement.compare(self.pictures(1, scale, where=where), self.pictures(2)).agrees)

    def test_pictures_without_noise_are_held_to_rounding(self):
        flat = agreement.exact([(1.0, 1.0, 1.0)] * 108)
        for value, agrees in [(1.0001, True), (1.001, False)]:
            self.assertEqual(agreement.compare(agreement.exact([(value,) * 3] * 108), flat).agrees, agrees)
