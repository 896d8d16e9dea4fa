"""Every command in README.md and docs/ works as printed: each ```sh block runs, in order, in a scratch folder."""
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
NOT_HERE = re.compile(r"^(\./gloam (test|bench|mitsuba|gallery|pack)\b|\./gloam demo$|git clone|cd )")
NEEDS_A_CARD = re.compile(r"^GLOAM_PRESET=cuda ")  # and minutes of nvcc; gloam_cuda_test shows that it compiles
MINUTES = 60


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


class Documentation(unittest.TestCase):
    def run_page(self, path):
        with tempfile.TemporaryDirectory(prefix="gloam_docs_") as scratch:
            os.symlink(ROOT / "gloam", Path(scratch) / "gloam")
            for name in ["examples", "assets"]:  # copies: a scene may not read through links out of its root
                shutil.copytree(ROOT / name, Path(scratch) / name)
            own = {**os.environ, "GLOAM_CACHE": str(Path(scratch) / "cache")}  # a page clears it
            for command in commands(path):
                if NOT_HERE.match(command) or (NEEDS_A_CARD.match(command) and not shutil.which("nvidia-smi")):
                    continue
                serves = "--view" in command
                process = subprocess.Popen(["bash", "-c", "exec " + command if serves else command], cwd=scratch, text=True, env=own,
                                           stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                try:
                    output, _ = process.communicate(timeout=8 if serves else 15 * MINUTES)
                except subprocess.TimeoutExpired:
                    self.assertTrue(serves, f"{path.name}: `{command}` did not end")
                    process.send_signal(signal.SIGINT)
                    output, _ = process.communicate(timeout=30)
                self.assertEqual(process.returncode, 0, f"{path.name}: `{command}` says\n{output}")

    def test_links_lead_somewhere(self):
        for path in [ROOT / "README.md", ROOT / "ARCHITECTURE.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]:
            prose = re.sub(r"^```.*?^```", "", path.read_text(), flags=re.M | re.S)
            for target in re.findall(r"\]\(([^)#]+)", prose):
                if "://" not in target:
                    self.assertTrue((path.parent / target).exists(), f"{path.name} links to {target}, which does not exist")


def add_page(path):
    setattr(Documentation, f"test_{path.stem.lower()}", lambda self: self.run_page(path))


for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
    if page.exists() and any(True for _ in blocks(page)):
        add_page(page)

if __name__ == "__main__":
    unittest.main()
