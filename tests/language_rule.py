"""Plain English: the number of phrases to avoid (tests/house.py) in README.md, docs/, public headers, docstrings and messages has a limit."""
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import house

# May only fall: lower it when the count falls, and reword new text instead of raising it.
MOST_PHRASES = 0


class Language(unittest.TestCase):
    def test_phrases_to_avoid_stay_under_their_limit(self):
        counts = house.phrase_counts()
        most = ", ".join(f"{name} {n}" for name, n in counts.most_common(5))
        self.assertLessEqual(sum(counts.values()), MOST_PHRASES, f"most in {most}; python3 tests/house.py --phrases FILE lists them")

    def test_the_limit_never_rose(self):
        history = subprocess.run(["git", "log", "--format=%h", "-G^MOST_PHRASES = ", "--", "tests/language_rule.py"], cwd=house.ROOT,
                                 capture_output=True, text=True).stdout.split()
        texts = [subprocess.run(["git", "show", f"{commit}:tests/language_rule.py"], cwd=house.ROOT, capture_output=True, text=True).stdout
                 for commit in history]
        earlier = [int(found.group(1)) for text in texts if (found := re.search(r"^MOST_PHRASES = (\d+)", text, re.M))]
        self.assertLessEqual(MOST_PHRASES, min(earlier, default=MOST_PHRASES))


class Measure(unittest.TestCase):
    def found(self, suffix, text):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"page{suffix}"
            path.write_text(text)
            return [(line, words.lower()) for _, line, words in house.phrases(path)]

    def test_of_documents(self):
        text = "# T\nIt tells what is wrong,\nfor whoever reads those\nof them. What is Gloam? A `what`.\n```toml\nwhat = 1  # said anew\n```\n"
        self.assertEqual(sorted(self.found(".md", text)), [(2, "tells"), (2, "what"), (3, "those of"), (3, "whoever"), (6, "anew"), (6, "said")])

    def test_of_headers_and_python(self):
        self.assertEqual(self.found(".h", "int what;  ///< lest it falls\n// obeys\n"), [(2, "obeys"), (1, "lest")])
        self.assertEqual(self.found(".py", 'what = 1  # told\ndef f():\n    """Returns\n    what it hears."""\n'), [(4, "what"), (4, "hears")])

    def test_of_messages(self):
        text = '#include "what is.h"\n// "it tells"\nfail("the file tells nothing", kWhat, "whatever");\n'
        self.assertEqual(self.found(".cc", text), [(3, "tells")])

    def test_plain_sentences_pass(self):
        self.assertEqual(self.found(".md", "Each run is recorded to one log. Those logs replay bit for bit; the server rejects others.\n"), [])


if __name__ == "__main__":
    unittest.main()
