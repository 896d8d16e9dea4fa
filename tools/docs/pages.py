"""Gathers the pages of the site: copies of the repository's Markdown at the same relative paths, so that links work unchanged,
and generated pages for the API references. Usage: pages.py PAGES SITE writes PAGES/mkdocs.yml and PAGES/site/."""
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import cpp_pages

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TOP = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"]
LINK = re.compile(r"\]\(([^)\s#]+)(?:#[^)]*)?\)")
ITEM = re.compile(r"^(?:[*-]|\d+\.) ")

# Pages of the Python reference: title, modules. "MODULE: NAME NAME" shows only these names of the module.
PYTHON = {
    "simulation": ("Simulations", ["gloam.simulation: load Simulation Checkpoint"]),
    "scene": ("Scenes, worlds and snapshots", ["gloam.scene", "gloam.world", "gloam.snapshot"]),
    "elements": ("Robots, bodies, joints and actuators", ["gloam.elements"]),
    "sensors": ("Cameras, LiDARs and sensors", ["gloam.cameras"]),
    "streams": ("Streams and their messages", ["gloam.streams", "gloam.frames", "gloam.messages"]),
    "info": ("Descriptions of worlds, simulations and logs", ["gloam.info"]),
    "logs": ("Logs", ["gloam.logs"]),
    "commands": ("Commands of the program", ["gloam.batch"]),
    "policies": ("Policies", ["gloam.policy"]),
    "envs": ("Gymnasium environments", ["gloam.envs"]),
    "distribute": ("Rollouts on many machines", ["gloam.distribute"]),
    "errors": ("Errors", ["gloam.errors"]),
    "notebook": ("Notebooks", ["gloam.notebook"]),
}


def for_site(text):
    """GitHub starts a list or table right after a paragraph; Python-Markdown needs a blank line before it."""
    lines, before, in_code = [], "", False
    for line in text.splitlines():
        in_code ^= line.lstrip().startswith("```")
        in_paragraph = before and not before.startswith((" ", "#", "|", "<!--")) and not ITEM.match(before)
        if not in_code and in_paragraph and (ITEM.match(line) or line.startswith("|")):
            lines.append("")
        lines.append(line)
        before = line
    return "\n".join(lines) + "\n"


def copy_page(path, folder):
    """Copies a page and the files, other than pages, that it links to."""
    target = folder / path.relative_to(ROOT)
    target.parent.mkdir(parents=True, exist_ok=True)
    text = source = path.read_text()
    if path.parent.name == "gallery":  # wide pages, whose titles differ from those of guides in the search
        text = "---\nhide: [toc]\n---\n" + re.sub(r"\A# (?!Gallery)", "# Gallery: ", text)
    target.write_text(for_site(text))
    for link in LINK.findall(source):
        file = (path.parent / link).resolve()
        if "://" not in link and file.is_file() and file.suffix != ".md" and file.is_relative_to(ROOT):
            copy = folder / file.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, copy)


def documents():
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "docs/*.md"],
                            cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
    return [ROOT / name for name in [*TOP, *listed] if (ROOT / name).exists()]


def sections():
    """Sections of docs/README.md: title, and the pages that each lists, as paths in the repository."""
    index = ROOT / "docs" / "README.md"
    for part in re.split(r"^## ", index.read_text(), flags=re.M)[1:]:
        title, _, body = part.partition("\n")
        links = [(index.parent / link).resolve().relative_to(ROOT).as_posix() for link in re.findall(r"^\* \[[^\]]*\]\(([^)#]+)\)", body, re.M)]
        yield title.strip(), links


def title(page):
    """The heading of a page up to its colon: "Logs" of "Logs: record, verify, recover"."""
    heading = re.search(r"^# (.*)$", (ROOT / page).read_text(), re.M).group(1)
    return heading.split(":")[0].replace("`", "")


def gallery():
    chapters = re.findall(r"\*\*\[[^\]]*\]\((\w+\.md)\)", (ROOT / "docs/gallery/README.md").read_text())
    return {"Gallery": ["docs/gallery/README.md", *({title(f"docs/gallery/{name}"): f"docs/gallery/{name}"} for name in chapters)]}


def navigation(cpp):
    start = ["README.md", {"Documentation": "docs/README.md"}, {"Glossary": "docs/glossary.md"}, {"Changelog": "CHANGELOG.md"}]
    nav = [{"Start": start}]
    for name, pages in sections():
        nav.append({name: [gallery() if page == "docs/gallery/README.md" else {title(page): page} for page in pages]})
    python = [{name: f"api/python/{key}.md"} for key, (name, _) in PYTHON.items()]
    nav.append({"Reference": ["api/README.md", {"Python": ["api/python/README.md", *python]}, {"C++": ["api/cpp/README.md", *cpp]}]})
    return nav


def directive(module):
    """Of mkdocstrings, for an entry of PYTHON."""
    name, _, members = module.partition(":")
    return f"::: {name}" + (f"\n    options:\n      members: {json.dumps(members.split())}" if members else "")


def python_reference(folder):
    folder.mkdir(parents=True)
    rows = []
    for key, (name, modules) in PYTHON.items():
        (folder / f"{key}.md").write_text(f"# {name}\n\n" + "\n\n".join(map(directive, modules)) + "\n")
        rows.append(f"* [{name}]({key}.md): " + ", ".join(f"`{module.split(':')[0]}`" for module in modules))
    (folder / "README.md").write_text("# Python reference\n\nAll public names are available from `import gloam`; the guide is\n"
                                      "[docs/python.md](../../docs/python.md).\n\n" + "\n".join(rows) + "\n")


def main(pages, site):
    shutil.rmtree(pages, ignore_errors=True)
    folder = pages / "site"
    for path in documents():
        copy_page(path, folder)
    shutil.copy(HERE / "style.css", folder / "style.css")
    python_reference(folder / "api" / "python")
    cpp = cpp_pages.Pages(ROOT / "include").write(folder / "api" / "cpp")
    (folder / "api" / "README.md").write_text(
        "# Reference\n\n* [Python](python/README.md): the package `gloam`, from its docstrings.\n"
        "* [C++](cpp/README.md): the public headers `include/gloam`, from their comments.\n")
    configuration = (HERE / "mkdocs.yml").read_text().replace("PYTHON_PACKAGE", json.dumps(str(ROOT / "python")))
    added = {"docs_dir": str(folder), "site_dir": str(site), "nav": navigation(cpp)}
    (pages / "mkdocs.yml").write_text(configuration + "".join(f"{key}: {json.dumps(value)}\n" for key, value in added.items()))


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
