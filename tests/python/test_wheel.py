"""The wheel of ./gloam wheel where nothing else is: no tools on the path, no home, no source tree."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ["GLOAM_BUILT"]).parents[1]
DEMO = """
import json
import gloam
sim = gloam.load(gloam.home() / "examples" / "demo.toml", seed=3)
sim.run_until(1.0)
frame = sim.cameras["quadruped/front"].render(("rgb",), width=64, height=48, spp=1)
print(json.dumps({"hash": sim.hash, "rgb": frame.rgb.tobytes().hex(), "home": str(gloam.home())}))
sim.close()
"""
# Libraries that any Linux of the wheel's tag has.
OF_THE_SYSTEM = re.compile(r"/(ld-linux-x86-64|lib(c|m|dl|rt|pthread|resolv|util|gcc_s|stdc\+\+))\.so[.\d]*$")


def run(*command: str | Path, **options: Any) -> str:
    result = subprocess.run(
        [str(part) for part in command], text=True, capture_output=True, stdin=subprocess.DEVNULL, **options
    )
    assert result.returncode == 0, (
        f"{command} ends with {result.returncode}\n{result.stdout[-3000:]}\n{result.stderr[-3000:]}"
    )
    return result.stdout


def hidden(command: list[str]) -> list[str]:
    """The command in a world without the source tree, its build and the wheels, where that can be had (root)."""
    places = {
        ROOT,
        BUILD.resolve(),
        (BUILD / "lib").resolve(),
        (ROOT / ".venv").resolve(),
        (ROOT / ".venv" / "wheels").resolve(),
    }
    script = " && ".join(f"mount -t tmpfs tmpfs '{place}'" for place in sorted(places, reverse=True)) + ' && exec "$@"'
    wrapped = ["unshare", "--mount", "sh", "-c", script, "sh"]
    can = subprocess.run([*wrapped, "true"], capture_output=True, cwd="/")
    return [*wrapped, *command] if can.returncode == 0 else command


def make_wheel(folder: Path, *options: str | Path) -> Path:
    return Path(
        run(sys.executable, ROOT / "tools" / "wheel.py", folder, "--prebuilt", BUILD, *options).splitlines()[-1]
    )


def install(wheel: Path, base: str, folder: Path) -> Path:
    """An environment of the wheel and NumPy alone. Returns its interpreter."""
    run(base, "-m", "venv", "--without-pip", folder)
    python = folder / "bin" / "python"
    text = (ROOT / "tests" / "python" / "requirements.txt").read_text()
    numpy = re.search(r"^numpy==(?:.*\\\n)*.*\n", text, re.M)
    assert numpy
    (folder / "numpy.txt").write_text(numpy.group())
    pip = [
        sys.executable,
        "-m",
        "pip",
        "--python",
        python,
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "--no-deps",
    ]
    run(*pip, "--require-hashes", "--only-binary=:all:", "-r", folder / "numpy.txt")
    run(*pip, wheel)
    return python


def run_the_demo(python: Path, folder: Path) -> dict[str, Any]:
    """What DEMO tells in an empty environment, run from elsewhere."""
    elsewhere = folder / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "demo.py").write_text(DEMO)
    env = {"PATH": "/nonexistent", "HOME": "/nonexistent", "GLOAM_CACHE": str(folder / "cache")}
    command = hidden(
        [
            "/usr/bin/env",
            "-i",
            *(f"{name}={value}" for name, value in env.items()),
            str(python),
            "-X",
            "faulthandler",
            "demo.py",
        ]
    )
    told: dict[str, Any] = json.loads(run(*command, cwd=elsewhere).splitlines()[-1])
    return told


def foreign_libraries(package: Path) -> set[str]:
    """Libraries that files of the package load, that are neither in it nor any Linux's."""
    found = set()
    files = [*package.glob("_core.*.so"), package / "bin" / "gloam", *package.glob("lib/**/*.so*")]
    for file in (
        file for file in files if "plugin" not in file.parts
    ):  # MuJoCo's plugins need it alone, which is loaded before
        for line in run("ldd", file).splitlines():
            name = line.split(" (")[0].split("=>")[-1].strip()
            if (
                not OF_THE_SYSTEM.search("/" + name)
                and "linux-vdso" not in name
                and not os.path.realpath(name).startswith(str(package))
            ):
                found.add(f"{file.name}: {line.strip()}")
    return found


def check(wheel: Path, base: str, folder: Path) -> None:
    python = install(wheel, base, folder / "environment")
    there = run_the_demo(python, folder)
    package = next((folder / "environment" / "lib").glob("python3.*")) / "site-packages" / "gloam"
    assert there["home"] == str(package / "share" / "gloam")
    assert foreign_libraries(package) == set(), "libraries of this machine that the wheel does not carry"
    here = json.loads(
        run(sys.executable, "-c", DEMO, env={**os.environ, "PYTHONPATH": str(ROOT / "python")}).splitlines()[-1]
    )
    assert there["hash"] == here["hash"]
    assert there["rgb"] == here["rgb"], "the same picture, so the same denoiser"
    version = run("/usr/bin/env", "-i", "PATH=/nonexistent", python.parent / "gloam", "--version", cwd=folder)
    assert version.startswith("gloam 0.")
    assert run(python, "-I", "-m", "gloam", "--version", cwd=folder) == version


def test_wheel_runs_where_nothing_else_is(tmp_path: Path) -> None:
    wheel = make_wheel(tmp_path / "wheels")
    major, minor = sys.version_info[:2]
    assert re.fullmatch(rf"gloam-[\d.]+-cp{major}{minor}-cp{major}{minor}-manylinux_2_\d+_x86_64\.whl", wheel.name)
    names = zipfile.ZipFile(wheel).namelist()
    for name in (
        "gloam/_core.pyi",
        "gloam/py.typed",
        "gloam/share/gloam/examples/demo.toml",
        "gloam/bin/gloam",
        "gloam/lib/libgloam.so.0.1",
    ):
        assert name in names
    assert not [
        name for name in names if "__pycache__" in name or name.startswith(("gloam/include", "gloam/lib/cmake"))
    ]
    carried = {
        name.split("/")[-1].split("-")[0] for name in names if re.fullmatch(r"gloam/lib/gloam/[^/]*\.so[.\d]*", name)
    }
    licences = {name.split("/")[2] for name in names if ".dist-info/licenses/" in name}
    embree = next(name for name in carried if name.startswith("libembree"))  # 3 or 4
    assert {"libtbb", "libzmq", "libopenh264"} <= carried
    assert {"libtbb12", f"{embree}-{embree[-1]}", "libzmq5", "mujoco_core", "pyoidn", "coacd", "LICENSE"} <= licences
    check(wheel, sys.base_prefix + f"/bin/python{major}.{minor}", tmp_path)


@pytest.mark.slow
def test_wheel_of_another_python(tmp_path: Path) -> None:
    other = "3.12" if sys.version_info[:2] != (3, 12) else "3.11"
    env = {**os.environ, "PYENV_VERSION": other}
    told = subprocess.run(
        ["sh", "-c", f"python{other} -c 'import sys; print(sys.executable)'"], capture_output=True, text=True, env=env
    )
    if told.returncode != 0:
        pytest.skip(f"there is no python{other} on this machine")
    base = told.stdout.strip()
    check(make_wheel(tmp_path / "wheels", "--python", base), base, tmp_path)
