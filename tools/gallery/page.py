"""The gallery's page. Its lines have 140 columns at most (tests/e2e/docs_test.py)."""
import html
import os
import textwrap

COLUMNS = 3
WIDEST = 480    # [px] on the page; the file has all of a picture
HEAD = """# Gallery
<!-- Made by ./gloam gallery from tools/gallery/chapters: edit those. -->

Pictures of what the path tier can show, each with the lines that make it. Every caption leads to a whole scene: copy
it, or render it with `./gloam render docs/gallery/scenes/NAME.toml --root . --spp 128`. Pictures are denoised, as
`gloam render` does.

{contents}
"""


def cell(picture):
    lines = "\n\n".join(text.strip() for text in (picture.mjcf, picture.toml) if text.strip())
    width = min(picture.size[0], WIDEST)
    shown = html.escape(lines, quote=False).replace("\n\n", "&#10;\n")  # a blank line would end the HTML block of Markdown
    return (f'<td valign="top" width="33%">\n<img src="{picture.file_name}.jpg" width="{width}"\n alt="{html.escape(picture.title)}"><br>\n'
            f'<a href="scenes/{picture.file_name}.toml">\n{html.escape(picture.title)}</a>'
            + (f"\n<pre>{shown}</pre>" if lines else "") + "</td>")


def table(pictures):
    rows = [pictures[i:i + COLUMNS] for i in range(0, len(pictures), COLUMNS)]
    return "<table>\n" + "\n".join("<tr>\n" + "\n".join(map(cell, row)) + "\n</tr>" for row in rows) + "\n</table>"


def text(chapters, folder):
    """The page of the pictures that are in the folder."""
    parts, contents = [], []
    for chapter in chapters:
        there = [picture for picture in chapter.pictures if (folder / f"{picture.file_name}.jpg").exists()]
        if there:
            contents.append(f"[{chapter.title}](#{chapter.title.lower().replace(' ', '-')})")
            parts.append(f"## {chapter.title}\n{chapter.text}\n\n{table(there)}\n")
    contents = textwrap.fill(" · ".join(contents), 120, break_long_words=False, break_on_hyphens=False)
    return HEAD.format(contents=contents) + "\n" + "\n".join(parts)


def write(chapters, folder):
    new = folder / "README.md.new"
    new.write_text(text(chapters, folder))
    os.replace(new, folder / "README.md")
