"""Views of a scene in the variants of the baselines."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import gloam
import numpy as np
import pytest
from gloam.real.appearance import describe
from gloam.real.views import GLOAM, MUJOCO, NO_INDIRECT, NO_NOISE, NO_TEXTURES, Shots, _flat, render
from PIL import Image

SHOTS = Shots(2, 64, 48, samples=16)
OURS = (GLOAM, NO_INDIRECT, NO_TEXTURES, NO_NOISE)


@pytest.fixture(scope="module")
def scene(examples: Path) -> gloam.Scene:
    return gloam.Scene(examples / "bedroom.toml")


@pytest.fixture(scope="module")
def out(scene: gloam.Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("views")
    render(scene, SHOTS, folder, OURS)
    return folder


def images(out: Path, variant: str) -> list[np.ndarray]:
    return [np.asarray(Image.open(file)) for file in sorted((out / variant).glob("*.png"))]


@pytest.mark.slow
def test_variants_lack_what_they_should(out: Path) -> None:
    found = {variant: images(out, variant) for variant in OURS}
    assert all([image.shape for image in every] == [(48, 64, 3)] * 2 for every in found.values())
    light = {variant: np.mean([describe(image)[0]["lightness"] for image in every]) for variant, every in found.items()}
    assert light[NO_INDIRECT] < light[GLOAM] - 5, "a room is lit by its walls"
    assert light[NO_NOISE] == pytest.approx(light[GLOAM], abs=1) and light[NO_TEXTURES] == pytest.approx(light[GLOAM], abs=4)
    noise = np.mean([np.abs(a.astype(int) - b).mean() for a, b in zip(found[GLOAM], found[NO_NOISE], strict=True)])
    texture = np.mean([np.abs(a.astype(int) - b).mean() for a, b in zip(found[GLOAM], found[NO_TEXTURES], strict=True)])
    assert 0.3 < noise < 8 and texture > noise
    assert np.abs(found[GLOAM][0].astype(int) - found[GLOAM][1]).mean() > 5, "two views"


@pytest.mark.slow
def test_materials_become_flat(scene: gloam.Scene) -> None:
    camera = {"name": "room", "width": 64, "height": 48}
    told: list[str] = []
    tables = _flat(scene, [camera], told.append)
    assert tables and any("keeps its image" in line for line in told)
    with gloam.Simulation(scene.overlay({"material": tables}).compile()) as sim:
        frame = sim.cameras["room"].render(("albedo", "segmentation"), width=160, height=120, tier="path", spp=4)
        material = {label.part: label.material for label in sim.labels()}
        parts, albedo = np.array(frame.part), np.array(frame.albedo)
        for table in tables:
            seen = np.isin(parts, [part for part, name in material.items() if name == table["name"]])
            assert not seen.any() or np.abs(albedo[seen] - table["pattern"]["color_a"]).max() < 0.01, table["name"]


@pytest.mark.slow
def test_a_repeated_call_renders_what_is_missing(scene: gloam.Scene, out: Path) -> None:
    before = {file: file.stat().st_mtime_ns for file in out.glob("*/*.png")}
    lost = out / GLOAM / "view_0001.png"
    pixels = np.asarray(Image.open(lost))
    lost.unlink()
    render(scene, SHOTS, out, OURS)
    assert np.array_equal(np.asarray(Image.open(lost)), pixels), "the same image again"
    assert all(file.stat().st_mtime_ns == stamp for file, stamp in before.items() if file != lost)
    with pytest.raises(gloam.UsageError, match="holds other views"):
        render(scene, Shots(3, 64, 48, samples=16), out, OURS)


def test_wrong_requests(scene: gloam.Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GLOAM_REAL_ENVIRONMENTS", str(tmp_path))
    for shots, variants, words in (
        (SHOTS, ("filament",), "no variant 'filament'"), (SHOTS, (MUJOCO,), "not installed"), (Shots(-1), OURS, "expected up to"),
        (Shots(fovy=0), OURS, "field of view"),
    ):  # fmt: skip
        with pytest.raises(gloam.UsageError, match=words):
            render(scene, shots, tmp_path / "out", variants)
    with pytest.raises(gloam.UsageError, match="no cameras"):
        render(gloam.Scene.from_dict({"environment": {"bedroom": {"seed": 1}}}), Shots(0), tmp_path / "out", OURS)


@pytest.mark.slow
def test_mujoco_has_the_same_cameras(scene: gloam.Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("mujoco")
    python = tmp_path / "real-mujoco" / "bin" / "python"
    python.parent.mkdir(parents=True)
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    monkeypatch.setenv("GLOAM_REAL_ENVIRONMENTS", str(tmp_path))
    shots = Shots(0, 64, 48, tier="direct", samples=4)
    try:
        render(scene, shots, tmp_path / "out", (MUJOCO, NO_NOISE))
    except gloam.Error as error:
        if "egl" in str(error).lower():
            pytest.skip(f"no EGL: {error}")
        raise
    theirs, ours = (images(tmp_path / "out", variant)[0].astype(float).mean(axis=2) for variant in (MUJOCO, NO_NOISE))
    assert theirs.std() > 5 and [camera["name"] for camera in json.loads((tmp_path / "out" / "views.json").read_text())["cameras"]] == [
        "room"
    ]

    def edges(grey: np.ndarray) -> np.ndarray:
        found = np.hypot(*np.gradient(grey))
        return found > np.quantile(found, 0.8)

    shared = (edges(theirs) & edges(ours)).mean()
    assert shared > 1.5 * 0.2 * 0.2, "edges coincide more often than by chance"
