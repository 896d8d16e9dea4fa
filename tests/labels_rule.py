"""The labels of tests/labels.txt fit tests, and no test's name gives its duration."""
import fnmatch
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TEST = re.compile(r"^(?:INSTANTIATE_TEST_SUITE_P|TYPED_TEST|TEST(?:_F|_P)?)\((\w+),\s*(\w+)", re.M)
LINE = re.compile(r"^(\w+) +(slow|full|sweeps|mutations) +(\S+)$")


def labels():
    """(module, label, pattern) of each line."""
    for line in (ROOT / "tests" / "labels.txt").read_text().splitlines():
        if not line.startswith("#"):
            yield LINE.match(line).groups()


def names(module="*"):
    for path in ROOT.glob(f"src/{module}/**/*_test.cc"):
        for first, second in TEST.findall(path.read_text()):
            yield f"{first}.{second}"
            yield f"Some/{first}.{second}"


class Labels(unittest.TestCase):
    def test_each_fits_a_test(self):
        for module, _, pattern in labels():
            self.assertTrue(fnmatch.filter(names(module), pattern), f"no test of src/{module} fits '{pattern}'")

    def test_each_module_with_sweeps_or_mutations_has_their_label(self):
        known = set(labels())
        for module in sorted(path.parent.name for path in ROOT.glob("src/*/test")):
            for label, pattern in (("sweeps", "*.DISABLED_Sweep*"), ("mutations", "*Mutations*")):
                if fnmatch.filter(names(module), pattern):
                    self.assertIn((module, label, pattern), known)

    def test_no_suite_is_called_slow(self):
        self.assertEqual(sorted({n for n in names() if re.search(r"Slow\.|\.Slow(?!BestEffort|Steps)", n)}), [])


if __name__ == "__main__":
    unittest.main()
