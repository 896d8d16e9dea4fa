"""Labels name tests that there are, and no test's name says how long it takes."""
import fnmatch
import re
import unittest
from pathlib import Path

import sys

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests"))
import labels  # noqa: E402

TEST = re.compile(r"^(?:INSTANTIATE_TEST_SUITE_P|TYPED_TEST|TEST(?:_F|_P)?)\((\w+),\s*(\w+)", re.M)


def names():
    for path in (ROOT / "src").rglob("*_test.cc"):
        for first, second in TEST.findall(path.read_text()):
            yield f"{first}.{second}"
            yield f"Some/{first}.{second}"


class Labels(unittest.TestCase):
    def test_each_fits_a_test(self):
        known = list(names())
        for patterns in (labels.SLOW, labels.FULL, labels.SWEEPS):
            for pattern in patterns:
                self.assertTrue(fnmatch.filter(known, pattern), f"no test is '{pattern}'")

    def test_no_suite_is_called_slow(self):
        self.assertEqual(sorted({n for n in names() if re.search(r"Slow\.|\.Slow(?!BestEffort|Steps)", n)}), [])


if __name__ == "__main__":
    unittest.main()
