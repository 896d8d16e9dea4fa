#!/usr/bin/env python3
"""Judges the path tier: the same scenes by Gloam and by Mitsuba 3, compared block by block (docs/mitsuba.md).

  ./gloam mitsuba             renders all scenes with both programs and compares them (five minutes)
  ./gloam mitsuba --stored    compares with the references that are kept here; needs no Mitsuba (a minute)
  ./gloam mitsuba --keep      also keeps Mitsuba's pictures, and those with one lobe or light scaled by 3 %, as references,
                              and writes docs/mitsuba.md's table and pictures (a quarter of an hour)
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import agreement  # noqa: E402
import gloam_form  # noqa: E402
import references  # noqa: E402
import scenes  # noqa: E402
from description import BLOCK, Scales  # noqa: E402

ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "bench"))
BATCHES = 32            # of either program
MUTATED_SHARE = 0.5     # of the batches, for pictures that must differ


def render(name, folder, scaled=""):
    """Gloam's picture of a scene, or of one with an input scaled by 3 %: (header, Estimate, pixels)."""
    description = scenes.ALL[name].describe(Scales(scaled))
    path = gloam_form.write(description, folder / "gloam" / f"{name}.{scaled}")
    program = ROOT / "build" / os.environ.get("GLOAM_PRESET", "release") / "bin" / "bench_path_blocks"
    out = folder / f"{name}.{scaled}.gloam"
    done = subprocess.run([program, path, out, "--camera", gloam_form.CAMERA, "--spp", str(description.spp),
                           "--batches", str(BATCHES), "--block", str(BLOCK)], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{name}: {done.stderr.strip()}")
    return agreement.read(out)


def stored(name):
    """(header, estimates by what is scaled); refuses references of an earlier description."""
    if not scenes.ALL[name].peer:
        return from_formula(name, mutated=True)
    header, estimates = references.read(name)
    if header["digest"] != references.digest(scenes.ALL[name].describe(Scales())):
        raise RuntimeError(f"{name} has changed since its reference was made: ./gloam mitsuba --keep --only {name}")
    return header, estimates


def closed_form(name, scaled=""):
    entry = scenes.ALL[name]
    return agreement.exact(entry.exact(entry.describe(Scales(scaled)))) if entry.exact else None


def from_formula(name, mutated):
    """As `stored`, of a scene that Mitsuba cannot render."""
    return {"spp": 0, "batches": 0}, {scaled: closed_form(name, scaled) for scaled in ["", *(scales_of(name)[0] if mutated else [])]}


def scales_of(name):
    """Names of what can be scaled: inputs, which both programs take, and lobes, which only Mitsuba does."""
    scales = Scales()
    scenes.ALL[name].describe(scales)
    return scales.inputs, scales.lobes


def judge(name, ours, theirs):
    """Named agreements of one scene: with Mitsuba, and of both with the closed form where there is one."""
    if not scenes.ALL[name].peer:
        return {"closed form": agreement.compare(ours, theirs)}
    found = {"Mitsuba": agreement.compare(ours, theirs)}
    truth = closed_form(name)
    if truth:
        found["closed form"] = agreement.compare(ours, truth)
        found["Mitsuba and closed form"] = agreement.compare(theirs, truth)
    return found


def undetected(ours, estimates):
    """Mutations that the comparison does not notice."""
    return [scaled for scaled, theirs in estimates.items() if scaled and agreement.compare(ours, theirs).agrees]


def ask_mitsuba(jobs, folder):
    """Renders by Mitsuba: (scene, scaled) pairs, one process."""
    import measure
    library = next(Path("/usr/lib").glob("*/libLLVM*19*.so*"), None) if measure.peer_python() else None
    if library is None:
        raise RuntimeError("libLLVM 19 is missing: apt-get install libllvm19")
    lines = [json.dumps({"scene": name, "scaled": scaled, "batches": round(BATCHES * (MUTATED_SHARE if scaled else 1))})
             for name, scaled in jobs]
    env = {**os.environ, "DRJIT_LIBLLVM_PATH": str(library)}
    with open(folder / "mitsuba.log", "w") as log, \
            subprocess.Popen([measure.peer_python(), HERE / "mitsuba_render.py", folder], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                             stderr=log, text=True, env=env) as process:
        process.stdin.write("\n".join(lines) + "\n")
        process.stdin.close()
        for line in process.stdout:
            job = json.loads(line)
            yield job["scene"], job["scaled"], agreement.read(folder / job["file"])
    if process.returncode != 0:
        raise RuntimeError("Mitsuba failed:\n" + "\n".join((folder / "mitsuba.log").read_text().splitlines()[-8:]))


def say(text):
    print(f"gloam: {text}", file=sys.stderr, flush=True)


def compare_all(folder, pictures_of):
    """Prints a line for each scene; returns rows for the table, and whether all is well."""
    rows, well = {}, True
    for name, (header, estimates) in pictures_of:
        our_header, ours, _ = render(name, folder)
        found, missed = judge(name, ours, estimates[""]), undetected(ours, estimates)
        for other, result in found.items():
            print(f"{'ok  ' if result.agrees else 'DIFF'} {name:<16} {other:<24} {result}", flush=True)
        for scaled in missed:
            print(f"MISS {name:<16} does not notice '{scaled}' scaled by 3 %", flush=True)
        rows[name] = {"found": found, "mutations": len(estimates) - 1, "missed": missed, "cpu": our_header["cpu_seconds"],
                      "spp": our_header["spp"] * our_header["batches"], "reference_spp": header["spp"] * header["batches"]}
        well = well and not missed and all(result.agrees for result in found.values())
    return rows, well


def from_mitsuba(names, folder, mutated):
    yield from ((name, from_formula(name, mutated)) for name in names if not scenes.ALL[name].peer)
    jobs = [(name, scaled) for name in names if scenes.ALL[name].peer for scaled in ["", *(sum(scales_of(name), []) if mutated else [])]]
    if not jobs:
        return
    estimates = {}
    for done, (name, scaled, (header, estimate, _)) in enumerate(ask_mitsuba(jobs, folder), 1):
        say(f"Mitsuba: {name} {scaled} ({done} of {len(jobs)})")
        estimates[scaled] = estimate
        if not scaled:
            first = header
        if done == len(jobs) or jobs[done][0] != name:
            header = {"scene": name, "digest": references.digest(scenes.ALL[name].describe(Scales())), **first}
            if mutated:
                references.keep(name, header, estimates)
            yield name, (header, estimates)
            estimates = {}


def main():
    parser = argparse.ArgumentParser(prog="./gloam mitsuba", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog="Scenes: " + ", ".join(scenes.ALL))
    parser.add_argument("--only", metavar="NAME", default="", help="the scene NAME, or those with NAME in their name")
    parser.add_argument("--stored", action="store_true", help="against the references that are kept")
    parser.add_argument("--keep", action="store_true", help="keep Mitsuba's pictures as references; write the table and pictures")
    args = parser.parse_args()
    names = [args.only] if args.only in scenes.ALL else [name for name in scenes.ALL if args.only in name]
    if not names or (args.stored and args.keep):
        parser.error(f"no scene has '{args.only}' in its name" if not names else "--stored and --keep exclude each other")
    with tempfile.TemporaryDirectory(prefix="gloam_mitsuba_") as scratch:
        folder = Path(scratch)
        pictures = ((name, stored(name)) for name in names) if args.stored else from_mitsuba(names, folder, args.keep)
        rows, well = compare_all(folder, pictures)
        if args.keep:
            import report
            report.write(rows, folder, complete=not args.only)
    return 0 if well else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (RuntimeError, OSError, ValueError) as problem:
        say(f"error: {problem}")
        sys.exit(1)
    except KeyboardInterrupt:
        sys.exit(130)
