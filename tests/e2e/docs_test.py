"""Every command in README.md and docs/ works as printed: each ```sh block runs, in order, in a scratch folder.

A ```toml block whose first line is the comment "# examples/NAME.toml" is saved there first. And of all documents: lines are
no longer than a screen is wide, links lead somewhere, docs/README.md lists every page.
"""
import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# The tests and the benches themselves: this test is part of the first, the others take an hour.
NOT_HERE = re.compile(r"^(\./gloam (test|bench|mitsuba|gallery|pack|wheel|docs)\b|\./gloam demo$|git clone|cd )")
# Minutes of two cores, of code that other commands run too: only with GLOAM_TEST_FULL=1, as `./gloam test full` sets it.
IN_FULL = re.compile(r"^\./gloam (demo adversity --quick|replay fire\.mcap .*(smoky|night)\.toml|report clear smoky night)")
NEEDS_A_CARD = re.compile(r"^GLOAM_PRESET=cuda ")  # and minutes of nvcc; gloam_cuda_test shows that it compiles
MINUTES = 60
WIDEST = 140  # [columns]; prose is wrapped at 120


def blocks(path):
    for match in re.finditer(r"^```sh\n(.*?)^```", path.read_text(), re.M | re.S):
        yield match.group(1)


def commands(path):
    for block in blocks(path):
        text = block.replace("\\\n", " ")
        for line in text.splitlines():
            line = line.strip()
            if line and not line.startswith("#"):
                yield line


def save_scenes(path, folder):
    for name, text in re.findall(r"^```toml\n# (examples/\w+\.toml)\n(.*?)^```", path.read_text(), re.M | re.S):
        (folder / name).write_text(text)


def documents():
    listing = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [ROOT / name for name in listing.splitlines() if (ROOT / name).exists()]


def without_code(text):
    return re.sub(r"^```.*?^```|<pre>.*?</pre>|`[^`\n]*`", "", text, flags=re.M | re.S)


def anchors(path):
    """Of the page's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", path.read_text(), flags=re.M | re.S), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Rules(unittest.TestCase):
    """Of every document that git knows; nothing is run."""

    def test_lines_are_no_wider_than_a_screen(self):
        long = [f"{path.relative_to(ROOT)}:{number}: {len(line)} columns" for path in documents()
                for number, line in enumerate(path.read_text().splitlines(), 1) if len(line) > WIDEST]
        self.assertEqual(long, [], f"wrap prose at 120; tables: shorter cells, notes below, or a list; at most {WIDEST}")

    def test_links_lead_somewhere(self):
        bad = []
        for path in documents():
            text = without_code(path.read_text())
            targets = re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r'(?:href|src)="([^"]+)"', text)
            for target in (t for t in targets if "://" not in t):
                file, _, anchor = target.partition("#")
                page = path.parent / file if file else path
                if not page.exists():
                    bad.append(f"{path.relative_to(ROOT)} links to {target}, which does not exist")
                elif anchor and anchor not in anchors(page):
                    bad.append(f"{path.relative_to(ROOT)} links to {target}, where no heading is called so")
        self.assertEqual(bad, [])

    def test_the_index_lists_every_page(self):
        index = (ROOT / "docs/README.md").read_text()
        pages = sorted(path.name for path in (ROOT / "docs").glob("*.md") if path.name != "README.md")
        self.assertEqual([name for name in pages if f"]({name})" not in index], [])


class Documentation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="gloam_docs_cache_")
        cls.addClassCleanup(folder.cleanup)
        cls.cache = folder.name  # of all pages: each would compile the same scenes

    def run_page(self, path):
        with tempfile.TemporaryDirectory(prefix="gloam_docs_") as scratch:
            os.symlink(ROOT / "gloam", Path(scratch) / "gloam")
            for name in ["examples", "assets"]:  # copies: a scene may not read through links out of its root
                shutil.copytree(ROOT / name, Path(scratch) / name)
            save_scenes(path, Path(scratch))
            clears = any("gloam cache clear" in command for command in commands(path))
            own = {**os.environ, "GLOAM_CACHE": str(Path(scratch) / "cache") if clears else self.cache}
            for command in commands(path):
                if NOT_HERE.match(command) or (NEEDS_A_CARD.match(command) and not shutil.which("nvidia-smi")):
                    continue
                if IN_FULL.match(command) and not os.environ.get("GLOAM_TEST_FULL"):
                    continue
                serves = "--view" in command.split() or command.startswith("./gloam studio")
                process = subprocess.Popen(["bash", "-c", "exec " + command if serves else command], cwd=scratch, text=True, env=own,
                                           stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                try:
                    output, _ = process.communicate(timeout=8 if serves else 15 * MINUTES)
                except subprocess.TimeoutExpired:
                    self.assertTrue(serves, f"{path.name}: `{command}` did not end")
                    process.send_signal(signal.SIGINT)
                    output, _ = process.communicate(timeout=30)
                self.assertEqual(process.returncode, 0, f"{path.name}: `{command}` says\n{output}")


def add_page(path):
    setattr(Documentation, f"test_{path.stem.lower()}", lambda self: self.run_page(path))


for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
    if page.exists() and any(True for _ in blocks(page)):
        add_page(page)

if __name__ == "__main__":
    unittest.main()
