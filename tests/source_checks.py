"""The format of all sources, and clang-tidy on the sources that changed last: on all of them it takes half an hour.

`./gloam test` runs these checks, `./gloam test full` with GLOAM_TEST_FULL=1: clang-tidy on all sources.
"""
import json
import os
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "release"
BACK = 30  # commits on the upstream itself
MOST = 8  # files that lint checks; the full tests check all
# The compile commands are GCC's: clang-tidy ignores unknown options and warnings that only Clang has.
IGNORED = ("unknown-warning-option", "unused-command-line-argument", "deprecated-declarations", "bitwise-instead-of-logical")


def git(*arguments):
    return subprocess.run(["git", *arguments], cwd=ROOT, text=True, capture_output=True).stdout.split()


def tracked(*patterns):
    return [name for name in git("ls-files", "--cached", "--others", "--exclude-standard", *patterns) if (ROOT / name).exists()]


def changed(*patterns):
    """Existing files that changed since the work branched off from its upstream, newest first. All in a clone without history."""
    base, head = git("merge-base", "HEAD", "origin/main"), git("rev-parse", "HEAD")
    if not base or base == head:
        base = git("rev-list", "--first-parent", f"--skip={BACK}", "-n", "1", "HEAD")
    if not base:
        return tracked(*patterns)
    names = dict.fromkeys(git("log", "--name-only", "--pretty=", f"{base[0]}..HEAD", "--", *patterns))
    return [name for name in names if (ROOT / name).exists()]


def commands_of_each_file(folder):
    """Writes compile_commands.json with an entry for every source, also if several are compiled as one."""
    entries = json.loads((BUILD / "compile_commands.json").read_text())
    for entry in [entry for entry in entries if "/Unity/" in entry["file"]]:
        for source in re.findall(r'#include "(.*)"', Path(entry["file"]).read_text()):
            entries.append(entry | {"file": source, "command": entry["command"].replace(entry["file"], source)})
    (folder / "compile_commands.json").write_text(json.dumps(entries))


def test_sources_are_formatted():
    files = tracked("*.h", "*.cc", "*.cu", "*.cuh")
    result = subprocess.run(["clang-format-19", "--dry-run", "--Werror", *files], cwd=ROOT, text=True, capture_output=True)
    faulty = sorted(set(re.findall(r"^(\S+?):\d+:\d+: error", result.stderr, re.M)))
    assert result.returncode == 0, f"clang-format-19 -i {' '.join(faulty)}\n{'' if faulty else result.stderr}"


def test_clang_tidy_finds_no_fault(tmp_path):
    everything = bool(os.environ.get("GLOAM_TEST_FULL"))
    names = (tracked if everything else changed)("src/*.cc", "apps/*.cc")
    files = [name for name in names if not re.search("/(fuzz|test|cuda)/", name)][:None if everything else MOST]
    commands_of_each_file(tmp_path)
    result = subprocess.run(["xargs", "-r", "-P2", "-n4", "clang-tidy-19", "-p", str(tmp_path), "--quiet",
                             *("--extra-arg=-Wno-" + name for name in IGNORED)],
                            cwd=ROOT, text=True, input="\n".join(files), stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    faults = [line for line in result.stdout.splitlines() if re.search(r"(error|warning): .*\[", line)]
    assert result.returncode == 0, "\n".join(faults[:30]) or result.stdout[-4000:]
