"""The folder rule: a folder of src/ includes only folders above it, and outsiders see include/gloam/ only."""
import re
import subprocess
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ORDER = ["base", "trajectory", "ros", "mcap", "geometry", "places", "scene", "world", "instant", "sim", "render", "sensors", "policy", "control", "metrics", "topics", "record",
         "runtime", "report"]
PARTS = {"runtime": ["rendering", "streams", "live", "log", "recording", "jobs"]}  # folders of a module, likewise
OUTSIDERS = ["src/web", "src/bridge", "src/studio", "src/teleop", "src/python", "apps"]
OUTSIDERS_MAY = {"src/bridge": {"ros"}, "src/python": {"ros"}}  # messages of a standard, independent of the simulator
THREADS = "base/threads/"  # hand-offs between threads, independent of the simulator
SOURCE_DIR = "base/test/source_dir.h"  # where tests find files of the source
MUJOCO_LIST = re.compile(r"MuJoCo's types are visible only in `([a-z/ ]+)` and in `([a-z/]+)`")  # in ARCHITECTURE.md
# memcpy is how bits are reinterpreted on both sides; intrinsics stand behind guards of the host.
STD_IN_KERNEL = re.compile(r"^\s*#include\s+<(?!cmath|cstdint|cstddef|cfloat|cstring|[a-z]mmintrin)")
MOST_FILES = 40
INCLUDE = re.compile(r'^\s*#include\s+["<]([^">]+)[">]', re.M)


def mujoco_folders():
    found = MUJOCO_LIST.search((ROOT / "ARCHITECTURE.md").read_text())
    return {name.rstrip("/") for name in " ".join(found.groups()).split()}


def rank_of_tests(module):
    """Of the lowest module that tests may include: simulations of the runtime, where CMake's TEST_DEPENDS names it."""
    lists = ROOT / "src" / module / "CMakeLists.txt"
    _, _, named = (lists.read_text() if lists.is_file() else "").partition("TEST_DEPENDS")
    return max(ORDER.index(name) for name in (module, *re.findall(r"gloam_(\w+)", named.partition(")")[0])) if name in ORDER)


def sources(folder):
    for path in sorted((ROOT / folder).rglob("*")):
        if path.suffix in (".h", ".cc", ".cu", ".cuh") and path.is_file():
            yield path


class FolderRule(unittest.TestCase):
    def test_modules_include_only_modules_above_them(self):
        bad = []
        for module in ORDER:
            for path in sources(f"src/{module}"):
                if "/fuzz/" in str(path):
                    continue
                rank = rank_of_tests(module) if "/test/" in str(path) else ORDER.index(module)
                for include in INCLUDE.findall(path.read_text()):
                    top = include.split("/")[0]
                    if top in ORDER and ORDER.index(top) > rank:
                        bad.append(f"{path.relative_to(ROOT)} includes {include}, which lies below it")
        self.assertEqual(bad, [])

    def test_parts_of_a_module_include_only_parts_above_them(self):
        bad = []
        for module, order in PARTS.items():
            for rank, part in enumerate(order):
                self.assertTrue(list(sources(f"src/{module}/{part}")), f"src/{module}/{part} has no sources")
                for path in sources(f"src/{module}/{part}"):
                    for include in INCLUDE.findall(path.read_text()):
                        top, *inner = include.split("/")
                        if top == module and (inner[0] not in order or order.index(inner[0]) > rank):
                            bad.append(f"{path.relative_to(ROOT)} includes {include}, which lies below it")
        self.assertEqual(bad, [])

    def test_outsiders_see_the_public_api_only(self):
        bad = []
        for folder in OUTSIDERS:
            for path in sources(folder):
                for include in INCLUDE.findall(path.read_text()):
                    top = include.split("/")[0]
                    if top in ORDER and top not in OUTSIDERS_MAY.get(folder, ()) and not include.startswith((THREADS, SOURCE_DIR)):
                        bad.append(f"{path.relative_to(ROOT)} includes {include}; only gloam/ is allowed there")
        self.assertEqual(bad, [])

    def test_mujoco_types_stay_in_their_folders(self):
        seen = {}
        for path in [*sources("src"), *sources("apps")]:
            top, inner, *_ = path.relative_to(ROOT).parts
            if "/test/" not in str(path) and re.search(r'#include\s+[<"]mujoco/', path.read_text()):
                seen.setdefault(inner if top == "src" else top, str(path.relative_to(ROOT)))
        self.assertEqual(set(seen), mujoco_folders(), f"ARCHITECTURE.md lists the folders that see MuJoCo's types; they are seen in {seen}")

    def test_there_is_one_list_of_folders_that_see_mujoco_types(self):
        listing = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.h", "*.cc", "*.md", "*.py"],
                                 cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
        lists = [name for name in listing if (ROOT / name).exists()
                 and re.search(r"scene/,? (?:and )?world/,? (?:and )?sim/", re.sub(r"\s*\n\s*(?://|#)?\s*", " ", (ROOT / name).read_text()))]
        self.assertEqual([name for name in lists if name != "tests/folder_rule.py"], ["ARCHITECTURE.md"])

    def test_kernel_is_device_safe(self):
        bad = []
        for path in sources("src/render/kernel"):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                if STD_IN_KERNEL.search(line) or re.search(r"\b(virtual|throw|std::)\b", line.split("//")[0]):
                    bad.append(f"{path.relative_to(ROOT)}:{number}: {line.strip()}")
        self.assertEqual(bad, [], "device-safe code has no std containers, virtuals or exceptions")

    def test_folders_stay_small(self):
        full = {}
        for folder in [p for top in ("src", "include", "apps") for p in (ROOT / top).rglob("*") if p.is_dir()]:
            files = [p for p in folder.iterdir() if p.is_file()]
            if len(files) > MOST_FILES and not {"test", "fuzz"} & set(folder.parts):
                full[str(folder.relative_to(ROOT))] = len(files)
        self.assertEqual(full, {}, f"a folder has at most {MOST_FILES} files")

    def test_files_stay_short(self):
        for suffix, usual, longest in ((".cc", 250, 540), (".h", 150, 410)):
            lengths = {str(path.relative_to(ROOT)): len(path.read_text().splitlines())
                       for top in ("src", "include", "apps") for path in sources(top)
                       if path.suffix == suffix and not {"test", "fuzz"} & set(path.parts)}
            over = [name for name, length in lengths.items() if length > usual]
            self.assertLess(len(over), len(lengths) / 8, f"seven of eight {suffix} files have at most {usual} lines: {over}")
            self.assertEqual([name for name in over if lengths[name] > longest], [], f"no {suffix} file has more than {longest} lines")

    def test_public_headers_are_one_concept_each(self):
        long = [p.name for p in (ROOT / "include/gloam").glob("*.h") if len(p.read_text().splitlines()) > 150]
        self.assertEqual(long, [])


if __name__ == "__main__":
    unittest.main()
