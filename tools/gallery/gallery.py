#!/usr/bin/env python3
"""Makes docs/gallery: a picture of every material, pattern, lamp, sky, medium, lens and sensor, with the scene that produces it.

  ./gloam gallery                all pictures, scenes and pages (about half an hour on two cores)
  ./gloam gallery --only glass   pictures with "glass" in CHAPTER/NAME; pages show all pictures that exist
  ./gloam gallery --text-only    pages only; renders nothing
  ./gloam gallery --models DIR   a contact sheet of all models in a folder, and a list of the ones that are too dark or too small
  ./gloam gallery --quick        small and noisy pictures in build/gallery, to check that every scene still renders (one seed per place)

Chapters are tools/gallery/chapters/*.toml. Each picture is a few lines added to a set in tools/gallery/sets.
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
CHANNELS = {"rgb": ["rgb", "radiance"], "boxes": ["rgb", "boxes"], "parts": ["segmentation"], "classes": ["segmentation"]}  # by default one channel, named like `show`
TO_ROOT = "../../../"     # from the sets and from docs/gallery/scenes


def say(text, end="\n"):
    print(f"gloam: {text}", file=sys.stderr, flush=True, end=end)


def write_scene(picture, folder):
    """Writes the picture's complete scene as a file for `gloam render`."""
    path = folder / "scenes" / f"{picture.file_name}.toml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(picture.scene().replace(TO_ROOT, os.path.relpath(ROOT, path.parent) + "/"))
    return path


def gloam(*arguments):
    """Runs the program; returns its error message, or None."""
    done = subprocess.run([PROGRAM, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    return done.stderr.strip() if done.returncode != 0 else None


def shoot(picture, scene, scratch, size, spp, threads):
    """Returns the picture as a file that ffmpeg reads, and a description of its fault or None."""
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
    """Writes folder/NAME.jpg; returns a description of its fault, or None."""
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
    new = folder / f"{picture.file_name}.jpg.new"     # renamed when complete, so that Ctrl-C leaves no partial file
    new.write_bytes(data)
    new.replace(folder / f"{picture.file_name}.jpg")


def render_all(pictures, folder, quick):
    """Renders, printing progress and the remaining time; returns the names of faulty pictures."""
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
    """All pictures except places that differ from an earlier one only in their seed, such as house_3_above from house_1_above."""
    places, chosen = set(), []
    for picture in pictures:
        place = re.sub(r"_\d+", "", picture.key) if picture.chapter == "environments" else picture.name
        if place not in places:
            chosen.append(picture)
        places.add(place)
    return chosen


def main():
    parser = argparse.ArgumentParser(prog="./gloam gallery", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="TEXT", default="", help="render only pictures with TEXT in CHAPTER/NAME")
    parser.add_argument("--quick", action="store_true", help="render small and noisy pictures")
    parser.add_argument("--text-only", action="store_true", help="write the pages without rendering")
    parser.add_argument("--models", type=Path, metavar="FOLDER",
                        help="make a contact sheet of all MJCF and URDF models in FOLDER, lit as by default, in --out or build/models")
    parser.add_argument("--out", type=Path, help="output folder inside the repository (default: docs/gallery, or build/gallery with --quick)")
    args = parser.parse_args()
    if args.models:
        return models.run(PROGRAM, args.models.resolve(), (args.out or ROOT / "build" / "models").resolve(), say)
    folder = (args.out or (DRAFT if args.quick else BOOK)).resolve()
    if not folder.is_relative_to(ROOT):
        parser.error(f"{folder} is outside {ROOT}; scenes refer to their sets by relative paths")
    chapters = read_chapters(HERE)
    if args.text_only:
        page.write(chapters, folder)
        print(folder / "README.md")
        return 0
    pictures = [picture for chapter in chapters for picture in chapter.pictures if args.only in picture.name]
    if args.quick:
        pictures = one_of_each_place(pictures)
    if not pictures:
        parser.error(f"no picture name contains '{args.only}'")
    broken = render_all(pictures, folder, args.quick)
    page.write(chapters, folder)
    say(f"{len(pictures) - len(broken)} of {len(pictures)} pictures without faults: {folder}")
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
