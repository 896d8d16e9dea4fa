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
    there = [name for name in scenes.ALL if name in lines]
    table = ["| scene | blocks that agree | chi-square | picture z | difference | closed form | largest error | samples | mutations |",
             "|---|---|---|---|---|---|---|---|---|", *(lines[name] for name in there),
             "", *(f"* **{name}**: {scenes.ALL[name].title}" for name in there)]
    PAGE.write_text(head + BEGIN + "\n" + "\n".join(table) + "\n" + END + tail)
    if complete:
        sheet = {"folder": str(folder), "out": str(ROOT / "docs" / "images" / "mitsuba.jpg"), "scenes": list(scenes.ALL),
                 "exact": {name: closed_form(name).mean for name in scenes.ALL if not scenes.ALL[name].peer}}
        subprocess.run([measure.peer_python(), HERE / "sheet.py", json.dumps(sheet)], check=True)


def table_line(name, row):
    peer = scenes.ALL[name].peer
    found = row["found"]["Mitsuba" if peer else "closed form"]
    exact = row["found"].get("closed form")
    from_exact = "" if not exact else f"{100 * exact.difference:+.3f} %" if peer else "alone"
    return (f"| {name} | {found.share:.1%} | {found.chi_square:.2f} | {found.picture_z:+.1f} | {100 * found.difference:+.3f} % | "
            f"{from_exact} | {100 * found.ours:.2f} / {100 * found.theirs:.2f} % | {row['spp']} / {row['reference_spp']} | "
            f"{row['mutations'] - len(row['missed'])} of {row['mutations']} |")
