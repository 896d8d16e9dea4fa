"""A contact sheet of every model in a folder: `./gloam gallery --models FOLDER [--out FOLDER]`.

Each MJCF and URDF file that compiles on its own is rendered by the free camera with default options. The sheet lists the area
that the model covers and its brightness; `faults` reports pictures that are too dark or in which the model is too small.
"""
import html
import json
import re
import subprocess
import tempfile
import time
from pathlib import Path

from pixels import raw

LEAST_MEDIAN = 60                   # of 255, of the model's pixels
LEAST_COVER, MOST_COVER = 0.1, 0.6  # of the picture
SIZE = (320, 240)


def models_in(folder):
    """Files with the root element of a model. Files meant for inclusion are detected later, when they fail to compile."""
    for path in sorted([*folder.rglob("*.xml"), *folder.rglob("*.urdf")]):
        head = path.read_text(errors="replace")[:4000]
        if re.search(r"<(mujoco|robot)[\s>]", re.sub(r"<!--.*?-->", "", head, flags=re.S)):
            yield path


def measure(program, model, root, out, spp=8):
    """Renders one model; returns {"picture", "cover", "median", "mean"}, or {"skipped": reason}."""
    done = subprocess.run([program, "-q", "render", model, "--camera", "free", "--spp", str(spp), "--resolution", f"{SIZE[0]}x{SIZE[1]}", "--root",
                           root, "--output", "rgb,segmentation", "--out", out], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != 0:
        return {"skipped": (done.stderr.strip().splitlines() or ["failed"])[-1]}
    grey = raw(out / "free.png", "gray")
    parts = raw(out / "free_part.png", "gray16le")
    drawn = [grey[i] for i in range(len(grey)) if parts[2 * i] or parts[2 * i + 1]]
    if not drawn:
        return {"skipped": "draws nothing"}
    drawn.sort()
    return {"picture": str(out / "free.png"), "cover": len(drawn) / len(grey), "median": drawn[len(drawn) // 2], "mean": sum(grey) / len(grey)}


def faults(result):
    """Describes each fault of a picture."""
    if result["median"] < LEAST_MEDIAN:
        yield f"dark: median {result['median']} of 255"
    if result["cover"] < LEAST_COVER:
        yield f"a speck: {100 * result['cover']:.0f} % of the picture"
    if MOST_COVER < result["cover"] < 0.95:  # more than that is a floor to the horizon, not a robot
        yield f"too near: {100 * result['cover']:.0f} % of the picture"


def write_sheet(out, results):
    cells = []
    for name, r in results.items():
        if "skipped" in r:
            continue
        wrong = "; ".join(faults(r))
        cells.append(f'<figure><img src="{html.escape(Path(r["picture"]).relative_to(out).as_posix())}" width="{SIZE[0]}"><figcaption>{html.escape(name)}'
                     f'<br>{100 * r["cover"]:.0f} %, median {r["median"]}{"<br><b>" + html.escape(wrong) + "</b>" if wrong else ""}</figcaption></figure>')
    (out / "index.html").write_text('<!doctype html><meta charset="utf-8"><title>Models</title><style>body{font:12px sans-serif;display:flex;flex-wrap:wrap;gap:8px}'
                                    "figure{margin:0;width:320px}b{color:#b00}</style>" + "\n".join(cells))
    pictures = [r["picture"] for r in results.values() if "picture" in r]
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as listing:
        listing.write("".join(f"file '{Path(p).resolve()}'\nduration 1\n" for p in pictures))
        listing.flush()
        columns = 8
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "concat", "-safe", "0", "-i", listing.name, "-vf",
                        f"scale=200:-1,tile={columns}x{-(-len(pictures) // columns)}", "-frames:v", "1", out / "sheet.png"], check=False)


def run(program, folder, out, say):
    models = list(models_in(folder))
    if not models:
        say(f"error: no MJCF or URDF files in {folder}")
        return 1
    results, start = {}, time.time()
    for i, model in enumerate(models):
        name = model.relative_to(folder).as_posix()
        place = out / re.sub(r"[^\w.-]+", "_", name)
        place.mkdir(parents=True, exist_ok=True)
        results[name] = measure(program, model, folder, place)
        left = (time.time() - start) / (i + 1) * (len(models) - i - 1)
        say(f"{i + 1} of {len(models)} models, about {left:.0f} s left: {name}" + "".join(f"; {f}" for f in (faults(results[name]) if "picture" in results[name] else [results[name]["skipped"]])))
    write_sheet(out, results)
    (out / "models.json").write_text(json.dumps(results, indent=1))
    shown = [r for r in results.values() if "picture" in r]
    good = sum(not any(faults(r)) for r in shown)
    print(f"{out / 'index.html'}\n{good} of {len(shown)} models have good pictures ({100 * good / max(len(shown), 1):.1f} %); {len(results) - len(shown)} files do not compile on their own")
    return 0
