"""Folders of assets/robots: meshes are what their script makes, and each robot.toml fits its model."""
from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
from robots import ROBOTS, mujoco

SCRIPTS = sorted(ROBOTS.glob("*/make_meshes.py"))
ENTRIES = sorted(ROBOTS.glob("*/robot.toml"))


def named(path: Path) -> str:
    return path.parent.name


@pytest.mark.parametrize("script", SCRIPTS, ids=named)
def test_meshes_are_made_by_their_script(script: Path, tmp_path: Path) -> None:
    threads = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}  # more spin on a busy machine
    command = [sys.executable, "-B", str(script), str(tmp_path)]
    subprocess.run(command, check=True, capture_output=True, env={**os.environ, **threads})
    made = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    kept = {p.name: p.read_bytes() for p in (script.parent / "meshes").iterdir()}
    assert sorted(made) == sorted(kept)
    assert [name for name in made if made[name] != kept[name]] == []


@pytest.mark.parametrize("entry", ENTRIES, ids=named)
def test_entry_fits_its_model(entry: Path) -> None:
    table: dict[str, Any] = tomllib.loads(entry.read_text())
    file = entry.parent / table["file"]
    assert file.is_file() and table["description"]
    if file.suffix != ".xml":
        return  # MuJoCo's package does not read models in TOML
    model = mujoco.MjModel.from_xml_path(str(file))
    if "keyframe" in table:
        model.key(table["keyframe"])
    for sensor in table.get("sensor", []):
        mount = sensor["mount"].rstrip("*")
        bodies = [model.body(i).name for i in range(model.nbody)]
        places = bodies + [model.site(i).name for i in range(model.nsite)]
        names = [model.sensor(i).name for i in range(model.nsensor)] if sensor["kind"] == "sensor" else places
        assert any(name.startswith(mount) if mount != sensor["mount"] else name == mount for name in names), sensor
        assert all(body in bodies for body in sensor.get("hide", []))
