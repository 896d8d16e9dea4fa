"""Writes the gallery's Markdown: one page per chapter and an index. Lines have at most 140 columns (tests/e2e/docs_test.py)."""
import os
import textwrap

MOST_LINES = 48  # of a picture's scene shown beside it; the link in its caption leads to all of them
COMMENT = "<!-- Written by ./gloam gallery from tools/gallery/chapters. Edit the chapters, not this page. -->"
INTRODUCTION = """\
Pictures of everything that the path tier renders, each with the lines of the scene that produce it. Every caption links to
the complete scene file. Copy it, or render it with
`./gloam render docs/gallery/scenes/NAME.toml --root . --spp 128`. All pictures are denoised, as `gloam render` does by
default."""


def code(language, lines):
    """A fenced block, indented as part of a list item."""
    shown = lines.strip().splitlines()
    if len(shown) > MOST_LINES:
        shown = shown[:MOST_LINES] + [f"# ... {len(shown) - MOST_LINES} more lines in the scene file"]
    return textwrap.indent("\n".join([f"```{language}", *shown, "```"]), "    ", lambda line: bool(line.strip()))


def cards(items):
    """A grid on the documentation site, a plain list on other viewers of Markdown."""
    return '<div class="grid cards" markdown>\n\n' + "\n\n".join(items) + "\n\n</div>\n"


def alternative(text):
    return text.replace("`", "").replace("[[", "").replace("]]", "")


def card(picture):
    parts = [f"-   ![{alternative(picture.title)}]({picture.file_name}.jpg)\n\n    [{caption(picture)}](scenes/{picture.file_name}.toml)"]
    parts += [code(language, lines) for language, lines in (("xml", picture.mjcf), ("toml", picture.toml)) if lines.strip()]
    return "\n\n".join(parts)


def caption(picture):
    """The title; brackets in link texts need escapes unless they are code."""
    return picture.title if "`" in picture.title else picture.title.replace("[", "\\[").replace("]", "\\]")


def chapter_page(chapter, pictures):
    return (f"# {chapter.title}\n{COMMENT}\n\n{chapter.text}\n\n[All chapters of the gallery](README.md)\n\n{cards(map(card, pictures))}")


def index_card(chapter, pictures):
    cover = next((picture for picture in pictures if picture.key == chapter.cover), pictures[0])
    return (f"-   [![{alternative(cover.title)}]({cover.file_name}.jpg)]({chapter.key}.md)\n\n"
            f"    **[{chapter.title}]({chapter.key}.md)** ({len(pictures)} pictures)\n\n    {chapter.summary}")


def pages(chapters, folder):
    """Text of each page by file name, for the pictures that are in the folder."""
    there = {chapter.key: [picture for picture in chapter.pictures if (folder / f"{picture.file_name}.jpg").exists()] for chapter in chapters}
    filled = [chapter for chapter in chapters if there[chapter.key]]
    texts = {f"{chapter.key}.md": chapter_page(chapter, there[chapter.key]) for chapter in filled}
    index = cards(index_card(chapter, there[chapter.key]) for chapter in filled)
    return {"README.md": f"# Gallery\n{COMMENT}\n\n{INTRODUCTION}\n\n{index}", **texts}


def write(chapters, folder):
    texts = pages(chapters, folder)
    for name, text in texts.items():
        (folder / f"{name}.new").write_text(text)
        os.replace(folder / f"{name}.new", folder / name)
    for old in folder.glob("*.md"):
        if old.name not in texts:
            old.unlink()  # of a chapter that has been removed or renamed
