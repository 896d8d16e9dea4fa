"""The three scenes of the paper's comparison: their pairs give the camera of the image in which they were picked."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import gloam
from gloam.match.camera import OPTICAL, Camera, Lens
from gloam.match.match import Request, match
from gloam.match.pairs import read_pairs, scene_points
from gloam.match.photo import from_srgb, load_photo, to_srgb
from gloam.match.refine import Unknowns
from gloam.match.solve import solve
from gloam.match.view import Quality

NAMES = ("office_hallway", "flat_hallway", "bedroom")


def true_camera(sim: gloam.Simulation) -> Camera:
    frame = sim.cameras["stand_in"].render(("depth",), tier="direct", spp=1)
    height, width = frame.depth.shape
    return Camera(Lens.centred(width, height, float(frame.K[1, 1])), OPTICAL @ frame.pose.R.T, frame.pose.p)


def test_every_example_is_tested(examples: Path) -> None:
    files = {path.stem for path in (examples / "match").glob("*.toml")}
    assert files == {*NAMES, *(f"{name}_pairs" for name in NAMES)}


@pytest.mark.parametrize("name", NAMES)
def test_the_pairs_of_an_example_give_its_camera(name: str, examples: Path) -> None:
    pairs = read_pairs(examples / "match" / f"{name}_pairs.toml")
    with gloam.load(examples / "match" / f"{name}.toml") as sim:
        true, points = true_camera(sim), scene_points(sim, pairs)
    lens = Lens.centred(true.lens.width, true.lens.height, 1.0)
    solution = solve(np.array([pair.pixel for pair in pairs]), points, lens, Unknowns.FOCAL)
    assert solution.used.all() and 0.1 < solution.rms < 0.7
    assert (np.abs(solution.camera.p - true.p) < 4 * solution.position_error).all() and (solution.position_error < 0.02).all()
    assert abs(solution.camera.lens.f - true.lens.f) < 4 * solution.focal_error


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_an_example_is_matched_with_its_colours(name: str, examples: Path, tmp_path: Path) -> None:
    """A render with noise, one stop darker and with another white balance is recovered."""
    scene = gloam.Scene(examples / "match" / f"{name}.toml")
    gains, ev = np.array([0.75, 1.0, 1.3]), float(scene["render.ev100"]) + 1
    with gloam.load(scene) as sim:
        frame = sim.cameras["stand_in"].render(("rgb",), tier="path", spp=16, ev100=ev)
        true = true_camera(sim)
    light = from_srgb(np.asarray(frame.rgb) / 255) * gains
    light = light + np.random.default_rng(1).normal(0, 0.004, light.shape)
    Image.fromarray(to_srgb(light)).save(tmp_path / "photo.jpg", quality=92)
    pairs = read_pairs(examples / "match" / f"{name}_pairs.toml")
    request = Request(examples / "match" / f"{name}.toml", tmp_path / "out", quality=Quality(320, "path", 16))
    made = match(load_photo(tmp_path / "photo.jpg"), pairs, request)
    assert made.problem == "" and made.exposure is not None
    assert np.linalg.norm(made.solution.camera.p - true.p) < 0.02
    found = np.log2(made.exposure.gains) - made.exposure.ev100
    np.testing.assert_allclose(found, np.log2(gains) - ev, atol=0.1)
