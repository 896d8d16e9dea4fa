"""Hashes of what the examples make: states, pictures, scans. A change that must not change behaviour leaves them as they are.

    python3 tests/hashes.py            compares with tests/hashes.json
    python3 tests/hashes.py --write    keeps them as they are now
    python3 tests/hashes.py demo rain  these examples alone

One run of each example per tier and seed, small and short. Hashes are of raw radiance, exact channels, LiDAR, sensors and
states; the state hash is the program's own. They are those of one version on one type of machine (ARCHITECTURE.md, Determinism).
"""
import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
KEPT = ROOT / "tests/hashes.json"
RUNS = [("path", 1), ("path", 2), ("direct", 1)]
OUTPUTS = ["radiance_exr", "depth_exr", "segmentation", "normal_exr", "motion_exr", "boxes_json", "lidar", "sensors", "state"]
DURATION = 0.12  # [s] of simulation: two frames or more of a usual camera
# Of the wall clock, or of where the run was.
NOT_HASHED = {"summary.json", "metrics.csv"}


def hashes_of(folder):
    summary = json.loads((folder / "summary.json").read_text())
    files = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if p.is_file() and p.name not in NOT_HASHED):
        files.update(f"{path.relative_to(folder)} {hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return {"state": summary["final_state_hash"], "files": files.hexdigest()[:16]}


def run_one(program, scene, tier, seed):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        command = [program, "run", scene, "--duration", str(DURATION), "--resolution", "48x36", "--spp", "2", "--tier", tier,
                   "--no-denoise", "--device", "cpu", "--seed", str(seed), "--out", out, "--output", *OUTPUTS]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, cwd=ROOT)
        if done.returncode != 0:
            return {"error": done.stderr.strip().splitlines()[-1]}
        return hashes_of(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("examples", nargs="*", help="names of examples; default: all")
    parser.add_argument("--write", action="store_true", help="keep the hashes in tests/hashes.json")
    parser.add_argument("--program", default=ROOT / "build/release/bin/gloam")
    args = parser.parse_args()
    scenes = sorted((ROOT / "examples").glob("*.toml"))
    if args.examples:
        scenes = [s for s in scenes if s.stem in args.examples]
    kept = json.loads(KEPT.read_text()) if KEPT.exists() else {}
    count, bad, start = len(scenes) * len(RUNS), 0, time.time()
    for i, (scene, (tier, seed)) in enumerate((s, r) for s in scenes for r in RUNS):
        name = f"{scene.stem} {tier} {seed}"
        now = run_one(args.program, scene, tier, seed)
        left = (time.time() - start) / (i + 1) * (count - i - 1)
        if args.write:
            kept[name] = now
            said = " ".join(now.values())
        else:
            known = kept.get(name, {})  # "A or B": which of two coplanar faces a ray meets is Embree's choice
            is_same = known.keys() == now.keys() and all(now[k] in known[k].split(" or ") for k in now)
            bad += not is_same
            said = "same" if is_same else f"DIFFERS: {now}, kept {kept.get(name)}"
        print(f"{name}: {said} ({left:.0f} s left)", flush=True)
    if args.write:
        KEPT.write_text(json.dumps(kept, indent=1, sort_keys=True) + "\n")
    print(f"{count} runs, {bad} differ")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
