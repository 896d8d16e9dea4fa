"""The table of docs/mitsuba.md and its pictures."""
import json
import subprocess

import measure
import scenes
from judge import HERE, ROOT, closed_form

PAGE = ROOT / "docs" / "mitsuba.md"
BEGIN, END = "<!-- table: ./gloam mitsuba --keep -->", "<!-- end of table -->"


def write(rows, folder, complete):
    """Replaces the table's lines of `rows`; pictures are made anew only if all scenes are at hand."""
    text = PAGE.read_text()
    head, rest = text.split(BEGIN)
    old, tail = rest.split(END)
    lines = {line.split("|")[1].strip(): line for line in old.splitlines() if line.startswith("| ") and "---" not in line}
    lines.update({name: table_line(name, row) for name, row in rows.items()})
    table = ["| scene | what | blocks that agree | chi-square | picture z | difference | largest error, ours / theirs | samples | mutations |",
             "|---|---|---|---|---|---|---|---|---|", *(lines[name] for name in scenes.ALL if name in lines)]
    PAGE.write_text(head + BEGIN + "\n" + "\n".join(table) + "\n" + END + tail)
    if complete:
        sheet = {"folder": str(folder), "out": str(ROOT / "docs" / "images" / "mitsuba.jpg"), "scenes": list(scenes.ALL),
                 "exact": {name: closed_form(name).mean for name in scenes.ALL if not scenes.ALL[name].peer}}
        subprocess.run([measure.peer_python(), HERE / "sheet.py", json.dumps(sheet)], check=True)


def table_line(name, row):
    peer = scenes.ALL[name].peer
    found = row["found"]["Mitsuba" if peer else "closed form"]
    what = scenes.ALL[name].title
    if not peer:
        what += " (the closed form alone)"
    elif "closed form" in row["found"]:
        what += f" (from the closed form: {100 * row['found']['closed form'].difference:+.3f} %)"
    return (f"| {name} | {what} | {found.share:.1%} | {found.chi_square:.2f} | {found.picture_z:+.1f} | {100 * found.difference:+.3f} % | "
            f"{100 * found.ours:.2f} / {100 * found.theirs:.2f} % | {row['spp']} / {row['reference_spp']} | "
            f"{row['mutations'] - len(row['missed'])} of {row['mutations']} |")
