#!/usr/bin/env python3
"""Makes docs/gallery: a picture of every material, pattern, lamp, sky, medium, lens and sensor that Gloam has, with the scene that makes it.

  ./gloam gallery                all pictures, scenes and the page (some half an hour on two cores)
  ./gloam gallery --only glass   pictures with "glass" in chapter/name; the page is made of what is there
  ./gloam gallery --models DIR   a contact sheet of somebody's robots, and which are dark or specks
  ./gloam gallery --quick        small and noisy, into build/gallery: does every scene still render? (of generated places one seed)

Chapters are tools/gallery/chapters/*.toml, each picture a few lines that are added to a set of tools/gallery/sets.
"""
import argparse
import array
import os
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import clouds  # noqa: E402
import models  # noqa: E402
import page  # noqa: E402
import show  # noqa: E402
from chapters import read_chapters  # noqa: E402
from pixels import fault_of_display, fault_of_light, jpeg, raw  # noqa: E402

ROOT = HERE.parent.parent
PROGRAM = ROOT / "build" / os.environ.get("GLOAM_PRESET", "release") / "bin" / "gloam"
BOOK = ROOT / "docs" / "gallery"
DRAFT = ROOT / "build" / "gallery"
CHANNELS = {"rgb": ["rgb", "radiance"], "boxes": ["rgb", "boxes"], "parts": ["segmentation"], "classes": ["segmentation"]}  # others have one, of their name
TO_ROOT = "../../../"     # from the sets, and from the book's scenes


def say(text, end="\n"):
    print(f"gloam: {text}", file=sys.stderr, flush=True, end=end)


def write_scene(picture, folder):
    """The picture's whole scene, as a file that `gloam render` takes."""
    path = folder / "scenes" / f"{picture.file_name}.toml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(picture.scene().replace(TO_ROOT, os.path.relpath(ROOT, path.parent) + "/"))
    return path


def gloam(*arguments):
    """Runs the program; returns what it complains of, or nothing."""
    done = subprocess.run([PROGRAM, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    return done.stderr.strip() if done.returncode != 0 else None


def shoot(picture, scene, scratch, size, spp, threads):
    """The picture as a file that ffmpeg reads, and what is wrong with it."""
    out = scratch / "out"
    if picture.show == "signals":
        wrong = gloam("run", scene, "--root", ROOT, "--duration", str(picture.time), "--output", "sensors", "--out", out)
        return None if wrong else show.write_ppm(scratch / "shown.ppm", picture.size, show.signals(out, picture.camera, picture.size, picture.axis)), wrong
    common = [scene, "--root", ROOT, "--camera", picture.camera, "--spp", str(spp), "--resolution", f"{size[0]}x{size[1]}",
              "--out", out, *threads]
    shot = out / picture.camera.replace("/", "_")
    if picture.show == "events":
        wrong = gloam("run", *common, "--duration", str(picture.time), "--output", "events")
        return None if wrong else show.write_ppm(scratch / "shown.ppm", size, show.events(shot, size)), wrong
    channels = CHANNELS.get(picture.show, [picture.show])
    wrong = gloam("render", *common, "--time", str(picture.time), "--output", *channels)
    if wrong:
        return None, wrong
    if picture.show == "rgb":
        return f"{shot}.png", fault_of_light(array.array("f", raw(f"{shot}.exr", "gbrpf32le")))
    return show.write_ppm(scratch / "shown.ppm", size, getattr(show, picture.show)(shot, size)), None


def render(picture, folder, quick):
    """Writes folder/NAME.jpg; returns what is wrong with it, or nothing."""
    scene = write_scene(picture, folder)
    if picture.panels:
        return render_scans(picture, scene, folder)
    width, height, spp = (80, 60, 4) if quick else (*picture.size, picture.spp)
    with tempfile.TemporaryDirectory(prefix="gloam_gallery_") as scratch:
        path, wrong = shoot(picture, scene, Path(scratch), (width, height), spp, ["--threads", "1"] if quick else [])
        if path is None:
            return wrong
        wrong, data = wrong or fault_of_display(raw(path, "gray")), jpeg(path)
    keep(picture, folder, data)
    return wrong


def render_scans(picture, scene, folder):
    with tempfile.TemporaryDirectory(prefix="gloam_gallery_") as scratch:
        done = subprocess.run([PROGRAM, "run", scene, "--root", ROOT, "--duration", str(picture.time), "--overwrite", "--resolution", "16x16",
                               "--spp", "1", "--out", scratch], stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode != 0:
            return done.stderr.strip()
        keep(picture, folder, clouds.jpeg(Path(scratch), picture.panels, picture.size))


def keep(picture, folder, data):
    new = folder / f"{picture.file_name}.jpg.new"     # complete or absent, also after Ctrl-C
    new.write_bytes(data)
    new.replace(folder / f"{picture.file_name}.jpg")


def render_all(pictures, folder, quick):
    """Renders with progress and the time left; returns the names of pictures that are wrong."""
    broken, start = [], time.monotonic()
    cost = [1 if quick else picture.size[0] * picture.size[1] * picture.spp for picture in pictures]
    with ThreadPoolExecutor(os.cpu_count() if quick else 1) as pool:
        jobs = [pool.submit(render, picture, folder, quick) for picture in pictures]
        try:
            for i, (picture, job) in enumerate(zip(pictures, jobs)):
                wrong, share = job.result(), sum(cost[:i + 1]) / sum(cost)
                left = (time.monotonic() - start) * (1 - share) / share
                if wrong:
                    broken.append(picture.name)
                    say(f"{picture.name}: {wrong}")
                elif sys.stderr.isatty() or i % 10 == 9:
                    say(f"{i + 1} of {len(pictures)}: {picture.name}, about {left:.0f} s left")
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    return broken


def one_of_each_place(pictures):
    """All but the places that differ from one before by their seed alone: house_3_above from house_1_above."""
    places, chosen = set(), []
    for picture in pictures:
        place = re.sub(r"_\d+", "", picture.key) if picture.chapter == "environments" else picture.name
        if place not in places:
            chosen.append(picture)
        places.add(place)
    return chosen


def main():
    parser = argparse.ArgumentParser(prog="./gloam gallery", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="TEXT", default="", help="pictures with TEXT in chapter/name")
    parser.add_argument("--quick", action="store_true", help="small and noisy pictures")
    parser.add_argument("--models", type=Path, metavar="FOLDER",
                        help="instead, a contact sheet of all MJCF and URDF models in FOLDER, as a newcomer first sees each; into --out or build/models")
    parser.add_argument("--out", type=Path, help="another folder than docs/gallery or build/gallery, inside the repository")
    args = parser.parse_args()
    if args.models:
        return models.run(PROGRAM, args.models.resolve(), (args.out or ROOT / "build" / "models").resolve(), say)
    folder = (args.out or (DRAFT if args.quick else BOOK)).resolve()
    if not folder.is_relative_to(ROOT):
        parser.error(f"{folder} is not inside {ROOT}, where the scenes find their sets")
    chapters = read_chapters(HERE)
    pictures = [picture for chapter in chapters for picture in chapter.pictures if args.only in picture.name]
    if args.quick:
        pictures = one_of_each_place(pictures)
    if not pictures:
        parser.error(f"no picture has '{args.only}' in its name")
    broken = render_all(pictures, folder, args.quick)
    page.write(chapters, folder)
    say(f"{len(pictures) - len(broken)} of {len(pictures)} pictures are well: {folder}")
    print(folder / "README.md")
    return 1 if broken else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, ValueError, subprocess.CalledProcessError) as problem:
        say(f"error: {problem}")
        sys.exit(1)
    except KeyboardInterrupt:
        sys.exit(130)
