"""The recipes of docs/extending.md compile and cost what the page says.

A recipe is a file of tests/extending/: whole files of its own and lines of files that exist. They are written to a scratch
folder that the compiler looks into first; the files of the recipe, those that it changes and those that it leaves alone
but that know what it changes are checked by the compiler, without making code.
"""
import json
import re
import shlex
import subprocess
import tempfile
import tomllib
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
BUILD = ROOT / "build" / "release"
RECIPES = sorted((ROOT / "tests" / "extending").glob("*.toml"))


def section(title):
    """A section of the page, in one line."""
    page = (ROOT / "docs" / "extending.md").read_text()
    return " ".join(re.search(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", page, re.M | re.S).group(1).split())


def changed(text, line):
    """A file's text with a line of the recipe."""
    mark = line.get("after") or line.get("before") or line["replace"]
    if text.count(mark) != 1:
        raise AssertionError(f"{line['file']}: '{mark}' stands there {text.count(mark)} times, not once")
    if "replace" in line:
        return text.replace(mark, line["text"])
    at = text.index(mark)
    place = text.index("\n", at) + 1 if "after" in line else text.rfind("\n", 0, at) + 1
    return text[:place] + line["text"].strip("\n") + "\n" + text[place:]


def write_recipe(recipe, folder):
    """Writes the recipe's files and those that it changes. Returns the paths that are in it alone, and those that exist."""
    own, lines = {}, {}
    for file in recipe.get("file", []):
        own[file["path"]] = file["text"].lstrip("\n")
    for line in recipe["line"]:
        text = lines.get(line["file"]) or (ROOT / line["file"]).read_text()
        lines[line["file"]] = changed(text, line)
    for path, text in (own | lines).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    return list(own), list(lines)


def commands():
    """The compiler's command for a file of each module and of apps/, without its file."""
    found = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        target = re.search(r"CMakeFiles/(\w+)\.dir/", entry["command"])
        if target and "/cuda/" not in entry["file"]:
            words = shlex.split(entry["command"])
            found.setdefault(target.group(1), words[:words.index("-o")])
    return found


def check(path, folder, known):
    """What the compiler says of a file; "" = nothing."""
    module = "gloam" if path.startswith("apps/") else "gloam_" + path.split("/")[1]
    source = folder / path if (folder / path).exists() else ROOT / path
    first, *rest = known[module]
    own = [first, f"-I{folder}/src", f"-I{folder}/include", f"-I{ROOT}/apps", *rest, "-fsyntax-only", str(source)]
    done = subprocess.run(own, capture_output=True, text=True, cwd=BUILD, timeout=300)
    return "" if done.returncode == 0 else f"{path}\n{done.stderr[:4000]}"


class Recipes(unittest.TestCase):
    def test_each_compiles_and_touches_what_the_page_says(self):
        known = commands()
        for file in RECIPES:
            with self.subTest(file.stem), tempfile.TemporaryDirectory(prefix="gloam_recipe_") as scratch:
                recipe, folder = tomllib.loads(file.read_text()), Path(scratch)
                own, existing = write_recipe(recipe, folder)
                page = section(recipe["page"])
                needed = {line["file"] for line in recipe["line"] if not line.get("optional")}
                for name in needed:
                    self.assertTrue(name in page or f"{Path(name).parent}/" in page, f"the page does not name {name}")
                self.assertIn(f"**Existing files: {len(needed)}**", page)
                sources = [path for path in [*own, *existing, *recipe["compile"]] if path.endswith(".cc")]
                with ThreadPoolExecutor(2) as pool:
                    said = [text for text in pool.map(lambda path: check(path, folder, known), dict.fromkeys(sources)) if text]
                self.assertEqual(said, [], "\n".join(said))

    def test_a_recipe_that_lacks_a_line_does_not_compile(self):
        recipe = tomllib.loads((ROOT / "tests/extending/command.toml").read_text())
        recipe["line"] = [line for line in recipe["line"] if not line["file"].endswith("command_check.cc")]
        with tempfile.TemporaryDirectory(prefix="gloam_recipe_") as scratch:
            write_recipe(recipe, Path(scratch))
            self.assertIn("StopBody", check("src/sim/commands/command_check.cc", Path(scratch), commands()))


if __name__ == "__main__":
    unittest.main()
