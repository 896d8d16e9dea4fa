"""The gallery's page."""
import html
import os

COLUMNS = 3
WIDEST = 480    # [px] on the page; the file has all of a picture
HEAD = """# Gallery
<!-- Made by ./gloam gallery from tools/gallery/chapters: edit those. -->

What the path tier can show, each with the lines that make it. Every caption leads to a whole scene: copy it, or render it with
`./gloam render docs/gallery/scenes/NAME.toml --root . --spp 128`. Pictures are denoised, as `gloam render` does.

{contents}
"""


def cell(picture):
    lines = "\n\n".join(text.strip() for text in (picture.mjcf, picture.toml) if text.strip())
    width = min(picture.size[0], WIDEST)
    return (f'<td valign="top" width="33%"><img src="{picture.file_name}.jpg" width="{width}" alt="{html.escape(picture.title)}"><br>'
            f'<a href="scenes/{picture.file_name}.toml">{html.escape(picture.title)}</a>'
            + (f"<pre>{html.escape(lines)}</pre>" if lines else "") + "</td>")


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
    return HEAD.format(contents=" · ".join(contents)) + "\n" + "\n".join(parts)


def write(chapters, folder):
    new = folder / "README.md.new"
    new.write_text(text(chapters, folder))
    os.replace(new, folder / "README.md")
