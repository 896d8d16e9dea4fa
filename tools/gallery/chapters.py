"""The gallery's contents: chapters/*.toml as values."""
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path


@dataclass
class Picture:
    """One picture: a set, and the lines added to it."""
    chapter: str
    key: str
    title: str
    base: str                    # text of the set's scene; may be empty
    toml: str                    # lines added to the set
    mjcf: str                    # elements of the set's model to show beside the picture
    camera: str                  # or the name of a sensor, when signals are plotted
    size: tuple[int, int]
    spp: int
    time: float                  # simulation time of the picture [s]
    panels: list[dict]           # LiDAR scans to draw (clouds.py), instead of a camera's picture
    show: str = "rgb"            # channel to show: rgb, or a function of show.py
    axis: str = ""               # quantity and unit on the vertical axis of plotted signals

    @property
    def name(self):
        return f"{self.chapter}/{self.key}"

    @property
    def file_name(self):
        return f"{self.chapter}_{self.key}"

    def scene(self):
        return f"{self.base.rstrip()}\n\n{self.toml}" if self.base else self.toml


@dataclass
class Chapter:
    key: str
    title: str
    text: str                    # at the top of the chapter's page
    summary: str                 # one sentence for the index
    cover: str                   # key of the picture that the index shows
    pictures: list[Picture]


def element(folder, set_name, name):
    """The element with this name in the set's model, as written there."""
    text = (folder / "sets" / f"{set_name}.xml").read_text()
    found = re.search(rf'^ *<(\w+) name="{name}"[^>]*?(/>|>.*?</\1>)', text, re.M | re.S)
    if not found:
        raise ValueError(f"sets/{set_name}.xml has no element '{name}'")
    lines = found.group(0).splitlines()
    margin = len(lines[0]) - len(lines[0].lstrip())
    return "\n".join(line[margin:] for line in lines)


def read_picture(folder, chapter, data, defaults):
    entry = {**defaults, **data}
    unknown = set(entry) - {"name", "title", "set", "toml", "mjcf", "camera", "size", "spp", "time", "panels", "show", "axis"}
    if unknown:
        raise ValueError(f"chapter {chapter}: unknown {', '.join(sorted(unknown))} of picture '{entry.get('name')}'")
    base = (folder / "sets" / f"{entry['set']}.toml").read_text()
    mjcf = "\n".join(element(folder, entry["set"], name) for name in entry.get("mjcf", []))
    return Picture(chapter, entry["name"], entry["title"], base, entry.get("toml", ""), mjcf, entry.get("camera", "view"),
                   tuple(entry.get("size", (320, 240))), entry.get("spp", 40), entry.get("time", 0),
                   entry.get("panels", []), entry.get("show", "rgb"), entry.get("axis", ""))


def read_chapters(folder):
    """Chapters, ordered by file name: "20_patterns.toml" is chapter "patterns"."""
    chapters = []
    for path in sorted((Path(folder) / "chapters").glob("*.toml")):
        data, key = tomllib.loads(path.read_text()), path.stem.split("_", 1)[1]
        pictures = [read_picture(Path(folder), key, picture, data.get("all", {})) for picture in data["picture"]]
        if data["cover"] not in {picture.key for picture in pictures}:
            raise ValueError(f"chapter {key}: cover = \"{data['cover']}\" is not the name of one of its pictures")
        chapters.append(Chapter(key, data["title"], data["text"].strip(), data["summary"], data["cover"], pictures))
    names = [picture.file_name for chapter in chapters for picture in chapter.pictures]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise ValueError(f"duplicate picture names: {', '.join(sorted(twice))}")
    return chapters
