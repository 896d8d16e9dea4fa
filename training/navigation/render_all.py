"""Renders the scenes of routes.py and packs the images: `python3 -m training.navigation.render_all DATA --gloam PROGRAM`.

DATA/images/SCENE/*.png are the images; a scene that is complete is not rendered again. DATA/images_CONDITION.npz has
`images` (n, 64, 85, 3) uint8, `depths` (n, 64, 85) uint16 [mm] and `rows` (n,), their rows in routes.npz. Scenes that
fail, or for which there is no time left, are named in DATA/render.json and lack their rows. Rendering needs the standard
library only, packing NumPy and Pillow.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

WIDTH, HEIGHT = 85, 64


@dataclass(frozen=True)
class Renderer:
    """program: of Gloam; device: cuda or cpu; deadline: of time.monotonic() [s]."""

    program: str
    device: str
    deadline: float

    def render(self, scene: Path, folder: Path) -> dict[str, Any]:
        """Renders all cameras of a scene to a folder. The answer has the state done, kept, failed or late."""
        views = scene.read_text().count("[[camera]]")
        begin = time.monotonic()
        if _complete(folder) == views:
            return {"scene": scene.stem, "state": "kept", "views": views}
        if begin >= self.deadline:
            return {"scene": scene.stem, "state": "late", "views": 0}
        command = [self.program, "render", str(scene), "--tier", "interactive", "--device", self.device]
        command += ["--resolution", f"{WIDTH}x{HEIGHT}", "--time", "0", "--output", "rgb,depth_png"]
        command += ["--out", str(folder)]
        folder.mkdir(parents=True, exist_ok=True)
        with open(folder / "log.txt", "w+b") as log:
            code = _run(command, log, self.deadline)
            log.seek(0)
            message = log.read().decode(errors="replace").replace("\r", "\n").strip().splitlines()
        written = _complete(folder)
        state = "done" if code == 0 and written == views else "late" if code is None else "failed"
        answer = {"scene": scene.stem, "state": state, "views": written, "seconds": round(time.monotonic() - begin, 2)}
        if state == "failed":
            answer["message"] = " | ".join(message[-3:]) or f"exit code {code}, {written} of {views} images"
        return answer


def _complete(folder: Path) -> int:
    """Number of views with both files."""
    return sum((folder / f"{image.stem}_depth.png").exists() for image in folder.glob("v?????.png"))


def _run(command: list[str], log: Any, deadline: float) -> int | None:
    """Exit code of a command; None if it was stopped at the deadline."""
    try:
        process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
    except OSError as error:
        log.write(str(error).encode())
        return 127
    try:
        return process.wait(timeout=max(deadline - time.monotonic(), 0.1))
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return None


def render_all(data: Path, renderer: Renderer, jobs: int) -> list[dict[str, Any]]:
    """Renders all scenes of DATA/scenes with `jobs` processes at a time; clear and adversity of a place together."""
    order = _order(data)
    with ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(renderer.render, scene, data / "images" / scene.stem) for scene in order]
        reports = []
        for future in futures:
            reports.append(future.result())
            print(json.dumps(reports[-1]), flush=True)
    return reports


def _order(data: Path) -> list[Path]:
    """Scenes in the order in which routes.py wrote their places, so that any first part has all kinds of places."""
    scenes = sorted((data / "scenes").glob("*.toml"))
    places = data / "places.json"
    rank = {name: number for number, name in enumerate(json.loads(places.read_text()))} if places.exists() else {}
    return sorted(scenes, key=lambda scene: (rank.get(scene.stem.rsplit("_", 1)[0], len(rank)), scene.stem))


def pack(data: Path, condition: str) -> int:
    """Writes DATA/images_CONDITION.npz; the number of images in it."""
    import numpy as np
    from PIL import Image

    with np.load(data / "routes.npz") as table:
        names, place = [str(name) for name in table["names"]], table["place"]
    images, depths, rows = [], [], []
    for number, name in enumerate(names):
        mine = np.flatnonzero(place == number)
        folder = data / "images" / f"{name}_{condition}"
        if _complete(folder) != len(mine):
            continue
        for file in sorted(folder.glob("v?????.png")):
            with Image.open(file) as image, Image.open(folder / f"{file.stem}_depth.png") as depth:
                images.append(np.asarray(image.convert("RGB"), dtype=np.uint8))
                depths.append(np.asarray(depth).astype(np.uint16))
        rows.append(mine)
    size = (len(images), HEIGHT, WIDTH)
    stacks = {"images": np.reshape(images, (*size, 3)).astype(np.uint8), "depths": np.reshape(depths, size).astype(np.uint16)}
    index = np.concatenate(rows) if rows else np.zeros(0, np.int64)
    np.savez(data / f"images_{condition}.npz", **stacks, rows=index)
    return len(index)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--gloam", default="gloam", help="the program; default: on the path")
    parser.add_argument("--device", choices=["cuda", "cpu"], default="cuda")
    parser.add_argument("--jobs", type=int, default=6, help="scenes rendered at a time")
    parser.add_argument("--seconds", type=float, default=1e9, help="for rendering; scenes that are not finished are left out")
    options = parser.parse_args()
    begin = time.monotonic()
    renderer = Renderer(options.gloam, options.device, begin + options.seconds)
    reports = render_all(options.data, renderer, options.jobs)
    rendered = time.monotonic() - begin
    counts = {condition: pack(options.data, condition) for condition in ("clear", "adversity")}
    states = {state: sum(report["state"] == state for report in reports) for state in ("done", "kept", "failed", "late")}
    total = {"scenes": states, "images": counts, "render_s": round(rendered, 1), "all_s": round(time.monotonic() - begin, 1)}
    (options.data / "render.json").write_text(json.dumps({"total": total, "scenes": reports}, indent=1))
    print(json.dumps(total))
    if sum(counts.values()) == 0:
        raise SystemExit("no scene was rendered")


if __name__ == "__main__":
    main()
