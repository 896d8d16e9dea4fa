"""How far the interactive tier's pictures are from the path tier's: LDR-FLIP and mean radiance on moving scenes.

    python3 bench/interactive_error.py [--set small|realistic] [--quick] [--only NAMES] [--seeds N] [--samples N] [--keep FOLDER] [--json]

Each scene runs at 20 pictures a second; at some of them the path tier takes the same instant with many samples, which
are kept in .cache/interactive_references until the scene's file changes (remove them when the models it includes, their
materials or its generators change). Prints the mean and the 95th percentile per pixel of LDR-FLIP (gloam/real/flip.py),
means over seeds of the interactive tier, the worst seed's mean, how much of it may be noise of the path tier's own pictures
(two of them with half of the samples each differ by that), and how far the mean radiance is off, per channel. The set
`small` has five small scenes; `realistic` has the twelve of bench/realistic_scenes, through which the camera moves, and
references of 2048 samples. Needs numpy and Pillow.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
from dataclasses import dataclass

import numpy as np
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "python" / "gloam" / "real"))
from flip import flip  # noqa: E402

BIN = ROOT / "build" / os.environ.get("GLOAM_PRESET", "release") / "bin"
CHANNELS = ("red", "green", "blue")


MEAN, P95, RADIANCE = "FLIP mean", "FLIP 95 %", "radiance [%]"


@dataclass
class Scenes:
    folder: str
    camera: str
    of: dict  # by scene: samples of a reference's pixel; the pictures that are compared, of which --quick takes the second
    seeds: int  # of the interactive tier
    bars: dict


SETS = {
    # The first picture, one in motion, one later. A reference takes seconds on an NVIDIA card, up to 20 minutes on two cores.
    "small": Scenes("interactive_scenes", "view", {"moving_lamp": (8192, (0, 8, 20)), "closing_door": (8192, (0, 6, 20)), "running_robot": (8192, (0, 10, 20)),
                                            "glass_and_mirrors": (8192, (0, 8, 20)), "yard": (8192, (0, 8, 20))}, 8, {MEAN: 0.08, P95: 0.25}),
    # After a few pictures and after a second of motion. A reference takes 2 to 20 s on an NVIDIA card, up to 20 minutes on two cores.
    "realistic": Scenes("realistic_scenes", "from..to",
                        {scene: (2048, (4, 20)) for scene in ("demo_room", "plain_room", "house", "house_2", "bedroom", "office", "tunnel", "terrain",
                                                              "warehouse", "rain", "adversity_house", "adversity_warehouse")},
                        1, {MEAN: 0.08, RADIANCE: 5}),
}


def picture(path):
    return np.asarray(Image.open(path).convert("RGB")) / 255.0


def compare(scenes, scene, at, seed, samples, folder):
    """A row per frame: mean and 95th percentile of FLIP, its mean between the path tier's halves, radiance of both (R G B each)."""
    command = [BIN / "bench_interactive_pictures", ROOT / "bench" / scenes.folder / f"{scene}.toml", scenes.camera, folder,
               "--frames", str(max(at) + 1), "--at", ",".join(map(str, at)), "--seed", str(seed), "--spp", str(samples),
               "--references", ROOT / ".cache" / "interactive_references"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{scene}: {(result.stderr or result.stdout).strip()}")
    rows = []
    for frame, line in zip(at, result.stdout.splitlines()):
        path, interactive = (picture(f"{folder}/{who}_{frame}.png") for who in ("path", "interactive"))
        error = flip(path, interactive)
        noise = flip(*(picture(f"{folder}/half_{half}_{frame}.png") for half in (0, 1))).mean()
        strip = np.concatenate([path, interactive, np.repeat(error[..., None], 3, -1)], 1)
        Image.fromarray((strip * 255).astype(np.uint8)).save(f"{folder}/{scene}_{frame}.png")
        of_interactive, of_path = (list(map(float, part.split())) for part in line.split("mean")[1].split("/"))
        rows.append([error.mean(), np.percentile(error, 95), noise, *of_interactive, *of_path])
    return rows


def figures(scene, frame, of_seeds):
    """What is printed of one frame."""
    mean, p95, noise = of_seeds[:, :3].mean(axis=0)
    interactive, path = of_seeds[:, 3:6].mean(axis=0), of_seeds[:, 6:9].mean(axis=0)
    off = 100 * (interactive / np.maximum(path, 1e-12) - 1)
    return {"scene": scene, "picture": frame, MEAN: mean, P95: p95, RADIANCE: float(np.abs(off).max()), "worst seed": of_seeds[:, 0].max(),
            "halves": noise, "off": dict(zip(CHANNELS, off)), "path": dict(zip(CHANNELS, path))}


def line_of(row):
    off = ", ".join(f"{row['off'][c]:+.1f}" for c in CHANNELS)
    return (f"{row['scene']:19} picture {row['picture']:2}: FLIP mean {row[MEAN]:.4f} (worst seed {row['worst seed']:.4f}), 95 % {row[P95]:.4f} "
            f"(halves of the reference {row['halves']:.4f}); radiance {off} % of {row['path']['green']:.3g} cd/m²")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--set", choices=SETS, default="small", help="of scenes (default small)")
    parser.add_argument("--quick", action="store_true", help="one picture of each scene")
    parser.add_argument("--only", help="some of its scenes, separated by commas")
    parser.add_argument("--seeds", type=int, help="of the interactive tier (default: " + ", ".join(f"{s.seeds} of {n}" for n, s in SETS.items()) + ")")
    parser.add_argument("--samples", type=int, help="of a reference's pixel (default: " +
                        ", ".join(f"{min(s.of.values())[0]} to {max(s.of.values())[0]} of {n}" for n, s in SETS.items()) + ")")
    parser.add_argument("--keep", help="folder for the pictures")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    arguments = parser.parse_args()
    scenes = SETS[arguments.set]
    chosen = arguments.only.split(",") if arguments.only else list(scenes.of)
    if unknown := set(chosen) - set(scenes.of):
        parser.error(f"there is no scene {', '.join(sorted(unknown))}; there are: {', '.join(scenes.of)}")
    rows = []
    with tempfile.TemporaryDirectory() as spare:
        for scene in chosen:
            samples, at = scenes.of[scene]
            at, samples = at[1:2] if arguments.quick else at, arguments.samples or samples
            runs = np.array([compare(scenes, scene, at, seed, samples, arguments.keep or spare)
                             for seed in range(1, (arguments.seeds or scenes.seeds) + 1)])
            for frame, of_seeds in zip(at, runs.swapaxes(0, 1)):
                rows.append(figures(scene, frame, of_seeds))
                print(line_of(rows[-1]), file=sys.stderr if arguments.json else sys.stdout, flush=True)
    worst = {key: max(row[key] for row in rows) for key in (MEAN, P95, RADIANCE)}
    if arguments.json:
        print(json.dumps({"rows": rows, "worst": worst}))
    else:
        bars = {key: f" (bar {bar})" for key, bar in scenes.bars.items()}
        print("worst: " + ", ".join(f"{key} {value:.4f}{bars.get(key, '')}" for key, value in worst.items()))
    return 0 if all(worst[key] <= bar for key, bar in scenes.bars.items()) else 1


if __name__ == "__main__":
    sys.exit(main())
