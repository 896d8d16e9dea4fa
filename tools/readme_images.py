"""Images of README.md: `python3 tools/readme_images.py [replay] [walk]` renders docs/images/replay.jpg and docs/images/walk.gif again.

Needs ffmpeg and a built program. Each takes several minutes on two cores.
"""
import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs/images"
# Rows of the mosaic: an overlay of examples/house_fire.toml, and the samples per pixel at which its images look clean.
LOOKS = [("", 96), ("smoky", 160), ("night", 96)]
# A GIF holds 256 colours at most: ffmpeg derives the palette from the clip.
PALETTE = "split[a][b];[a]palettegen=max_colors=192[p];[b][p]paletteuse=dither=bayer:bayer_scale=4"


def run(*command):
    done = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stderr}")


def ffmpeg(*arguments):
    run("ffmpeg", "-v", "error", "-y", *arguments)


def record(program, scene, seconds, log):
    run(program, "-q", "record", f"examples/{scene}.toml", "-o", log, "--duration", seconds, "--topics", "/clock")


def images(program, log, size, rate, samples, overlay=""):
    """PNG files of the camera "chase" along the motion in a log, in order."""
    out = log.with_name(f"{log.stem}_{overlay}")
    camera = log.with_suffix(".toml")
    camera.write_text(f'[record]\noutputs = ["png"]\n[[camera]]\nname = "chase"\nwidth = {size[0]}\nheight = {size[1]}\nrate = {rate}\n')
    laid = ["--overlay", f"examples/overlays/{overlay}.toml"] if overlay else []
    run(program, "-q", "replay", log, "--folder", ROOT, "--camera", "chase", "--overlay", camera, *laid, "--tier", "path", "--spp", samples,
        "--max-depth", 8, "--out", out)
    return sorted((out / "chase/rgb").glob("*.png"))


def replay(program, folder):
    """The same walk down a hall three times, at three instants: clear, full of smoke, and at night."""
    width, height = 480, 300
    log = folder / "fire.mcap"
    record(program, "house_fire", 5, log)
    rows = [images(program, log, (width, height), 0.5, samples, overlay) for overlay, samples in LOOKS]
    tiles = [(path, f"{width * column}_{height * row}") for row, paths in enumerate(rows) for column, path in enumerate(paths)]
    inputs = [word for path, _ in tiles for word in ("-i", path)]
    layout = "|".join(place for _, place in tiles)
    ffmpeg(*inputs, "-filter_complex", f"xstack=inputs={len(tiles)}:layout={layout}", "-q:v", 3, IMAGES / "replay.jpg")


def walk(program, folder):
    """Five seconds of the demo."""
    log = folder / "walk.mcap"
    record(program, "demo", 5, log)
    first = images(program, log, (400, 250), 8, 16)[0]
    ffmpeg("-framerate", 8, "-i", first.with_name("%06d.png"), "-vf", PALETTE, "-loop", 0, IMAGES / "walk.gif")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("images", nargs="*", help="replay, walk; default: both")
    parser.add_argument("--program", default=ROOT / "build/release/bin/gloam")
    args = parser.parse_args()
    makers = {maker.__name__: maker for maker in (replay, walk)}
    if unknown := set(args.images) - set(makers):
        parser.error(f"no image is named {', '.join(sorted(unknown))}")
    with tempfile.TemporaryDirectory() as folder:
        for name in args.images or makers:
            makers[name](args.program, Path(folder))


if __name__ == "__main__":
    sys.exit(main())
