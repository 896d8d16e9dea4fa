"""Images of realistic scenes next to their requirements: `./gloam bench --only realistic`, on a card with `--device cuda`."""
import os
import tempfile
from pathlib import Path

from measure import BIN, CACHE, ROOT, at_least, at_most, interactive_error, milliseconds, peer_python, run, run_json, say

SCENES = ROOT / "bench" / "realistic_scenes"
PICTURES = CACHE / "bench_pictures" / "realistic"
TIER = "interactive"
# Milliseconds that an image of 640x480 may take on two CPU cores and on a card, in each scene of a row.
IMAGES = {"demo room, house, office, tunnel": (("demo_room", "house", "office", "tunnel"), {"cpu": 250, "cuda": 8}),
          "warehouse with people, terrain": (("warehouse", "terrain"), {"cpu": 350, "cuda": 10}),
          "adversity major in house and in warehouse": (("adversity_house", "adversity_warehouse"), {"cpu": 500, "cuda": 15})}
SMALL = {"224x224": {"cpu": 60, "cuda": 4}, "85x64": {"cpu": 12, "cuda": 2}}  # of the house [ms]
FIRST = {"cold": {"cpu": 3, "cuda": 1}, "warm": {"cpu": 1, "cuda": 0.5}}  # [s]
FLIP, RADIANCE = 0.08, 5


def rate(scene, device, cache, *options):
    return run_json(BIN / "bench_realistic_rate", SCENES / f"{scene}.toml", "--tier", TIER, "--device", device, "--json", *options,
                    GLOAM_CACHE=str(cache))


def classic(scene, folder, count):
    """Milliseconds of an image of MuJoCo's classic renderer on the exported model, or None."""
    try:
        run(BIN / "gloam", "export", SCENES / f"{scene}.toml", "--out", folder)
        return milliseconds(peer_python(), ROOT / "bench" / "peers" / "mujoco_render.py", Path(folder) / "scene.xml", "from", "classic",
                            640, 480, count, PICTURES / f"{scene}_classic.png")[0]
    except (RuntimeError, OSError) as problem:
        say(f"{scene} without MuJoCo's classic renderer: {problem}")
        return None


def measure_scene(scene, device, quick):
    """The figures of bench_realistic_rate; the time of a peer; the seconds to the first image without and with Gloam's cache."""
    with tempfile.TemporaryDirectory(prefix="gloam_bench_") as folder:
        cold = rate(scene, device, f"{folder}/cache", "--frames", 2)
        data = rate(scene, device, f"{folder}/cache", "--frames", 5 if quick else 21, "--out", PICTURES)
        first = {"cold": cold["first_ms"] / 1e3, "warm": data["first_ms"] / 1e3}
        sizes = {size: rate(scene, device, f"{folder}/cache", "--size", size, "--frames", 5 if quick else 41) for size in SMALL} if scene == "house" else {}
        return {**data, "first": first, "sizes": sizes, "classic": classic(scene, f"{folder}/exported", 2 if quick else 8)}


def image_note(data):
    peer = "" if data["classic"] is None else f", MuJoCo classic {data['classic']:.0f}"
    return f"{data['scene']} {data['image_ms']:.0f} (95 % {data['image_p95_ms']:.0f}, {data['rays'] / 1e6:.1f} M rays{peer})"


def rows(device, quick):
    every = sorted(path.stem for path in SCENES.glob("*.toml"))
    scenes = [name for name in os.environ.get("GLOAM_BENCH_SCENES", "").split(",") if name] or every
    if unknown := set(scenes) - set(every):
        raise RuntimeError(f"GLOAM_BENCH_SCENES: no {', '.join(sorted(unknown))}; there are: {', '.join(every)}")
    PICTURES.mkdir(parents=True, exist_ok=True)
    found = {scene: measure_scene(scene, device, quick) for scene in scenes}
    for what, (members, required) in IMAGES.items():
        if here := [found[scene] for scene in members if scene in found]:
            yield at_most(f"{what}: ms an image", max(data["image_ms"] for data in here), required[device],
                          "medians, the worst counts: " + "; ".join(map(image_note, here)))
    for size, data in (found["house"]["sizes"] if "house" in found else {}).items():
        yield at_most(f"house {size}: ms an image", data["image_ms"], SMALL[size][device], f"median; 95 % {data['image_p95_ms']:.1f}")
    for state, required in FIRST.items():
        each = sorted(found.values(), key=lambda data: -data["first"][state])
        yield at_most(f"first image after loading, {state} cache [s]", each[0]["first"][state], required[device],
                      "the worst counts: " + ", ".join(f"{data['scene']} {data['first'][state]:.2f}" for data in each))
    samples = os.environ.get("GLOAM_BENCH_SAMPLES", 8 if quick else "")
    error = interactive_error("--set", "realistic", "--only", ",".join(scenes), *(["--quick"] if quick else []), *(["--samples", samples] if samples else []))
    for key, name, required in (("FLIP mean", "mean LDR-FLIP against the path tier, worst scene", FLIP),
                                ("radiance [%]", "mean radiance against the path tier, worst channel [%]", RADIANCE)):
        each = sorted(error["rows"], key=lambda row: -row[key])
        noise = (lambda row: f" (halves {row['halves']:.3f})") if key == "FLIP mean" else (lambda row: "")
        yield at_most(name, error["worst"][key], required, "; ".join(f"{row['scene']} {row['picture']}: {row[key]:.3g}{noise(row)}" for row in each))
    for scene, data in found.items():
        yield at_least(f"physics / real time: {scene}", data["real_time_factor"], 1,
                       f"{data['physics_ms']:.1f} ms for the 50 ms between two images; ms an image: {image_note(data)}")


def realistic(quick):
    """images of twelve realistic scenes through which a camera moves while physics runs"""
    yield from rows("cpu", quick)


def realistic_card(quick):
    """the same twelve scenes on the card"""
    yield from rows("cuda", quick)


ALL = {realistic: 900}
CARD = {realistic_card: 600}
