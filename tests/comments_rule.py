"""Files that comments and documents name exist in the repository, so that a renamed file takes its mentions along."""
import re
import subprocess
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SLASHES = {".h", ".cc", ".cu", ".cuh", ".js", ".mjs"}
HASHES = {".toml", ".cmake"}
NAME = re.compile(r"(?<![\w./*<>{}$\-])((?:[\w\-]+/)*[\w\-]+\.(?:h|cc|cu|cuh|py|pyi|js|mjs|cmake|md))\b(?!\.\w)")
# Of other projects, and made by the build.
OUTSIDE = {"jpeglib.h", "zmq.h", "mjspec.h", "mujoco/mjspec.h", "mjspecmacro.h", "mjxmacro.h", "rl/exporter_utils.py",
           "mjcf_elements.h", "gloam/mjcf_elements.h", "_core.pyi", "FILE.cu",
           "ros/messages/PACKAGE.h", "ros/messages/gloam_msgs.h", "ros/messages/all_messages.h", "all_messages.h",
           # of the authors of GNM, ViNT and NoMaD
           "data_utils.py", "train/vint_train/data/data_utils.py", "vint_dataset.py", "deployment/src/utils.py", "navigate.py",
           "deployment/src/navigate.py", "pd_controller.py", "deployment/src/pd_controller.py", "create_topomap.py",
           "deployment/src/create_topomap.py", "conditional_unet1d.py"}


def comments(path, text):
    """Line numbers and texts of comments, of docstrings, and of documents outside of code blocks."""
    if path.suffix == ".md":
        blank = re.sub(r"^```.*?^```", lambda block: "\n" * block.group(0).count("\n"), text, flags=re.M | re.S)
        return list(enumerate(blank.splitlines(), 1))
    if path.suffix == ".py":
        strings = [(text[:found.start()].count("\n") + 1, found.group(1)) for found in re.finditer(r'"""(.*?)"""', text, re.S)]
        return strings + marked(text, r"(?:^|\s)#(.*)$")
    return marked(text, r"(?<!:)//(.*)$" if path.suffix in SLASHES else r"(?:^|\s)#(.*)$")


def marked(text, pattern):
    return [(number, found.group(1)) for number, line in enumerate(text.splitlines(), 1) if (found := re.search(pattern, line))]


def missing(path, text, ends):
    return [(number, name) for number, words in comments(path, text) for name in NAME.findall(words) if name not in ends | OUTSIDE]


class Comments(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True,
                                check=True).stdout.splitlines()
        cls.files = [ROOT / name for name in listed if (ROOT / name).exists()]
        # A mention may leave out leading folders: "surface/weathering.h".
        cls.ends = {"/".join(parts[i:]) for parts in (name.split("/") for name in listed) for i in range(len(parts))}

    def test_files_named_in_comments_and_documents_exist(self):
        bad = []
        for path in self.files:
            name = path.relative_to(ROOT).as_posix()
            if path.suffix in SLASHES | HASHES | {".py", ".md"} and not name.startswith(("tests/extending/", "tests/comments_rule.py", "CHANGELOG")):
                bad += [f"{name}:{number}: {file}" for number, file in missing(path, path.read_text(errors="replace"), self.ends)]
        self.assertEqual(bad, [], "comments name files that do not exist")

    def test_a_missing_file_is_found(self):
        for suffix, text in [(".h", "int a;  // see gone/gone.h"), (".py", 'def f():\n    """As gone.py has it."""\n'), (".toml", "a = 1  # gone.md"),
                             (".md", "See `src/gone.cc`.\n```sh\ncat other.py\n```\n")]:
            self.assertEqual(len(missing(Path("x" + suffix), text, {"world.h"})), 1, suffix)
        self.assertEqual(missing(Path("x.h"), '#include "gone.h"\n// world.h, https://example.org/a.md, FILE.h.in', {"world.h"}), [])


if __name__ == "__main__":
    unittest.main()
