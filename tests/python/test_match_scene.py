"""gloam match from end to end: "photographs" are renders with camera noise, another exposure and another white balance."""

from __future__ import annotations

import importlib.util
import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from _pytest.capture import CaptureResult
from match_scenes import ELEMENTS, looking, room
from PIL import Image

import gloam
from gloam.match.camera import OPTICAL, Array, Camera, Lens
from gloam.match.edges import edges_of
from gloam.match.exposure import fit_exposure
from gloam.match.pairs import Pair, scene_points, write_pairs
from gloam.match.photo import from_srgb, to_srgb
from gloam.match.view import camera_table, has_light, scene_with

ROOT = Path(__file__).resolve().parents[2]
SIZE = (320, 240)
LENS = replace(Lens.centred(*SIZE, 250.0), k1=-0.12, k2=0.02)
CAMERA = looking(LENS, np.array([-1.9, -2.3, 1.45]), np.array([0.0, 0.9, 0.7]), 0.03)
EXPOSURE = {"f_number": 2.8, "shutter": 0.1, "iso": 100.0}
EV = float(np.log2(2.8**2 / 0.1))
GAINS = np.array([0.8, 1.0, 1.4])


@dataclass(frozen=True)
class Shot:
    """scene, photograph and pairs in a folder; points: of the pairs in the world [m]; pixels: true ones [px]."""

    folder: Path
    points: Array
    pixels: Array
    pairs: tuple[Pair, ...]


@pytest.fixture(scope="module")
def shot(tmp_path_factory: pytest.TempPathFactory) -> Shot:
    folder = tmp_path_factory.mktemp("shot")
    pixel = {"shot_noise": True, "read_noise": 2.0, "bits": 10, "full_well": 20000}
    scene = scene_with(gloam.Scene(room(folder)), {**camera_table("secret", CAMERA), "imager": {"exposure": EXPOSURE, "pixel": pixel}})
    pairs = [Pair(f"{element} {corner}", (0, 0), None, kind, element, corner) for kind, element, corner in ELEMENTS]
    with gloam.load(scene) as sim:
        image = np.array(sim.cameras["secret"].render(("rgb",), tier="path", spp=32).rgb)
        points = scene_points(sim, pairs)
    Image.fromarray(to_srgb(from_srgb(image / 255) * GAINS)).save(folder / "photo.png")
    pixels, depth = CAMERA.project(points)
    assert (depth > 0).all() and (pixels > 0).all() and (pixels < SIZE).all()
    picked = np.round(pixels + np.random.default_rng(3).normal(0, 0.3, pixels.shape), 2)
    made = tuple(replace(pair, pixel=(float(u), float(v))) for pair, (u, v) in zip(pairs, picked, strict=True))
    write_pairs(folder / "pairs.toml", made)
    return Shot(folder, points, pixels, made)


Match = Callable[..., "CaptureResult[str]"]


@pytest.fixture
def match(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Match:
    """Runs the command line in an empty folder, and returns its output: .out and .err."""
    monkeypatch.chdir(tmp_path)
    spec = importlib.util.spec_from_file_location("match_commands", ROOT / "tools" / "match" / "commands.py")
    assert spec is not None and spec.loader is not None
    commands = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(commands)

    def run(*arguments: str | Path, expect: int = 0) -> CaptureResult[str]:
        try:
            code = commands.main(list(map(str, arguments)))
        except SystemExit as error:  # of argparse
            code = error.code
        output = capsys.readouterr()
        assert code == expect, f"{code}\n{output.out}\n{output.err}"
        return output

    return run


QUICK = ("--spp", "8", "--tier", "path")


def test_a_photograph_is_matched(shot: Shot, match: Match, tmp_path: Path) -> None:
    """Camera within its standard errors, exposure and gains as the photograph was made, and all files."""
    copy = shot.folder / "matched.toml"
    arguments = (shot.folder / "photo.png", shot.folder / "room.toml", "--pairs", shot.folder / "pairs.toml", "--solve", "k1")
    result = match(*arguments, "--out", "out", "--write", copy, *QUICK)
    found = json.loads((tmp_path / "out" / "match.json").read_text())
    position, error = np.array(found["position_m"]), np.array(found["position_error_m"])
    assert (np.abs(position - CAMERA.p) < 4 * error).all() and (error < 0.1).all()
    assert abs(found["lens"]["f_px"] - LENS.f) < 4 * found["focal_error_px"]
    assert 0.1 < found["rms_px"] < 0.7
    assert abs(found["lens"]["k1"] - LENS.k1) < 4 * np.sqrt(found["covariance"][7][7]) and found["covariance_of"][7] == "k1"
    gains = np.array(found["exposure"]["gains_rgb"])
    np.testing.assert_allclose(gains / gains[1], GAINS / GAINS[1], rtol=0.02)
    # The luminance of the gains depends on the colour of the light; the brightness of every channel does not.
    np.testing.assert_allclose(np.log2(gains) - found["exposure"]["ev100"], np.log2(GAINS) - EV, atol=0.06)
    names = {"pairs", "photo", "render", "balanced", "edges", "blend", "checkerboard"}
    assert {path.name for path in (tmp_path / "out").glob("[!.]*")} == {"camera.toml", "match.json", "match.html", *(f"{n}.png" for n in names)}
    assert "pairs" in result.out and str(copy) in result.out
    picture, photo = (np.asarray(Image.open(tmp_path / "out" / f"{name}.png")).astype(float) for name in ("balanced", "photo"))
    assert np.median(np.abs(picture - photo)) < 4


def test_the_written_camera_shows_the_scene_where_the_pairs_are(shot: Shot, match: Match) -> None:
    """The depth channel of Gloam's own camera at the projection of each visible point is the point's depth."""
    copy = shot.folder / "checked.toml"
    arguments = (shot.folder / "photo.png", shot.folder / "room.toml", "--pairs", shot.folder / "pairs.toml", "--solve", "k1", "--out", "out")
    match(*arguments, "--write", copy, *QUICK)
    with gloam.load(copy) as sim:
        frame = sim.cameras["photo"].render(("depth", "rgb"), width=4 * SIZE[0], height=4 * SIZE[1], tier="direct", spp=1)
        info, pose = frame.info, frame.pose
        solved = Camera(replace(LENS, f=float(frame.K[0, 0]) / 4, k1=info.d[0], k2=info.d[1]), OPTICAL @ pose.R.T, pose.p)
        labels = sim.labels()
    assert labels and frame.K[0, 2] == pytest.approx(2 * SIZE[0])
    pixels, depth = solved.project(shot.points)
    seen = 0
    for (u, v), z in zip(pixels, depth, strict=True):
        window = frame.depth[int(4 * v) - 1 : int(4 * v) + 3, int(4 * u) - 1 : int(4 * u) + 3]
        seen += bool((np.abs(window - z) < 0.004 * z).any())
    assert seen == len(shot.points)
    assert np.sqrt(np.mean(np.sum((pixels - shot.pixels) ** 2, axis=1))) < 0.5


def test_a_wrong_pair_is_named_with_its_residual(shot: Shot, match: Match, tmp_path: Path) -> None:
    pairs = list(shot.pairs)
    pairs[2] = replace(pairs[2], pixel=(pairs[2].pixel[0] + 30, pairs[2].pixel[1]), name="<b>table</b>")
    write_pairs(tmp_path / "pairs.toml", pairs)
    arguments = (shot.folder / "photo.png", shot.folder / "room.toml", "--pairs", "pairs.toml", "--out", "out", "--fovy", str(LENS.fovy))
    result = match(*arguments, "--solve", "k1", *QUICK, expect=3)
    assert "pair 3 ('<b>table</b>') contradicts the others and is left out" in result.err
    found = json.loads((tmp_path / "out" / "match.json").read_text())
    assert [row["used"] for row in found["pairs"]] == [i != 2 for i in range(len(pairs))]
    assert np.hypot(*found["pairs"][2]["residual_px"]) == pytest.approx(30, abs=2)
    page = (tmp_path / "out" / "match.html").read_text()
    assert "&lt;b&gt;table" in page and "<b>table" not in page and "contradicts the others" in page


def test_a_scene_without_light_has_a_camera_but_no_exposure(shot: Shot, match: Match, tmp_path: Path) -> None:
    dark = shot.folder / "dark.toml"
    dark.write_text('[environment]\nfile = "room.xml"\n')
    arguments = (shot.folder / "photo.png", dark, "--pairs", shot.folder / "pairs.toml", "--solve", "k1", "--out", "out")
    result = match(*arguments, *QUICK, expect=3)
    assert "the exposure is not fitted: the scene has no lamp and no sky" in result.err
    assert json.loads((tmp_path / "out" / "match.json").read_text())["exposure"] is None
    assert "no lamp and no sky" in (tmp_path / "out" / "match.html").read_text()
    assert "imager" not in (tmp_path / "out" / "camera.toml").read_text()


def test_lamps_places_and_glowing_materials_light_a_scene(tmp_path: Path) -> None:
    scene = room(tmp_path)
    bare = '[environment]\nfile = "room.xml"\n'
    glow = '[[material]]\nname = "red"\nemission = [3, 3, 3]\n'
    (tmp_path / "lit.xml").write_text((tmp_path / "room.xml").read_text().replace("<body ", '<light pos="0 0 2"/><body ', 1))
    texts = {bare: False, scene.read_text(): True, bare + "[sky]\ndate = 2026-06-21\ntime = 12:00:00\nlatitude = 48\nlongitude = 11\n": True, '[environment]\nfile = "lit.xml"\n': True}
    texts |= {"[environment.bedroom]\nseed = 1\n": True, bare + glow: True}
    for text, expected in texts.items():
        with gloam.load(gloam.Scene.parse(text, tmp_path)) as sim:
            assert has_light(sim) == expected, text


@pytest.mark.parametrize(
    ("change", "code", "problem"),
    [
        (("--pairs", "missing.toml"), 1, "cannot read the pairs"),
        (("--fovy", "200"), 2, "between 0 and 179"),
        (("--fovy", "nan"), 2, "between 0 and 179"),
        (("--solve", "k3"), 2, "--solve takes centre, k1, k2, got 'k3'"),
        (("--solve", "k2"), 2, "needs k1"),
        (("--longest", "100000"), 2, "--longest"),
        (("--mask", "missing.png"), 1, "cannot read the mask"),
        (("--name", "rough"), 2, "already exists"),
        (("--tier", "fast"), 2, "invalid choice"),
    ],
)
def test_wrong_calls_are_explained(shot: Shot, match: Match, change: tuple[str, ...], code: int, problem: str) -> None:
    arguments = (shot.folder / "photo.png", shot.folder / "room.toml", "--pairs", shot.folder / "pairs.toml", "--solve", "k1", *change)
    result = match(*arguments, "--out", "out", *(QUICK if "--tier" not in change else ()), expect=code)
    assert problem in result.err


def test_missing_scenes_and_photographs_are_explained(shot: Shot, match: Match) -> None:
    pairs = ("--pairs", shot.folder / "pairs.toml")
    assert "No such file" in match("photo.png", shot.folder / "room.toml", *pairs, expect=1).err
    assert "missing.toml" in match(shot.folder / "photo.png", "missing.toml", *pairs, expect=1).err
    assert "--pairs" in match(shot.folder / "photo.png", shot.folder / "room.toml", expect=2).err


def test_help_has_examples(match: Match) -> None:
    assert "gloam match photo.jpg room.toml --pairs" in match("--help").out
    assert "gloam match pick photo.jpg" in match("pick", "--help").out


# ---- exposure ----
def test_gains_are_recovered_in_spite_of_objects_that_differ() -> None:
    """Two fifths of the photograph show other things than the render."""
    rng = np.random.default_rng(0)
    radiance = rng.uniform(5, 60, (60, 80, 3))
    photo = radiance * np.array([1.3, 1.0, 0.7]) / (1.2 * 2**6.5)
    photo[:, :32] = rng.uniform(0.02, 0.8, (60, 32, 3))
    exposure = fit_exposure(photo, radiance, np.ones((60, 80), dtype=bool))
    gains = np.array(exposure.gains)
    np.testing.assert_allclose(gains / gains[1], [1.3, 1.0, 0.7], rtol=0.05)
    np.testing.assert_allclose(np.log2(gains) - exposure.ev100, np.log2([1.3, 1, 0.7]) - 6.5, atol=0.15)
    mask = np.zeros((60, 80), dtype=bool)
    mask[:, 32:] = True
    masked = fit_exposure(photo, radiance, mask)
    np.testing.assert_allclose(np.array(masked.gains) / masked.gains[1], [1.3, 1.0, 0.7], rtol=1e-9)
    assert np.array(masked.gains) @ [0.2126, 0.7152, 0.0722] == pytest.approx(1)
    np.testing.assert_allclose(np.median(masked.display(radiance)[mask] / photo[mask], axis=0), 1, rtol=1e-9)


def test_clipped_and_dark_photographs_have_no_exposure() -> None:
    radiance, usable = np.full((20, 20, 3), 10.0), np.ones((20, 20), dtype=bool)
    for photo in (np.ones((20, 20, 3)), np.full((20, 20, 3), 1e-4)):
        with pytest.raises(gloam.InputError, match="only 0 blocks"):
            fit_exposure(photo, radiance, usable)
    with pytest.raises(gloam.InputError, match="no light of the scene"):
        fit_exposure(np.full((20, 20, 3), 0.3), np.zeros((20, 20, 3)), usable)


def test_edges_are_those_of_the_geometry(tmp_path: Path) -> None:
    """The silhouette of a box in front of a wall, at the pixels where a pinhole camera projects it; none on plain surfaces."""
    (tmp_path / "box.xml").write_text(
        '<mujoco><worldbody><geom name="wall" type="box" size="5 .1 5" pos="0 3 0"/>'
        '<geom name="box" type="box" size=".5 .5 .5" pos="0 1.5 0"/></worldbody></mujoco>'
    )
    (tmp_path / "box.toml").write_text('[environment]\nfile = "box.xml"\n[[camera]]\nname = "a"\nposition = [0, -1, 0]\nlook_at = [0, 1, 0]\nfovy = 90\n')
    with gloam.load(tmp_path / "box.toml") as sim:
        frame = sim.cameras["a"].render(("depth", "normal", "segmentation", "albedo"), width=200, height=200, tier="direct", spp=1)
    edges = edges_of(frame)
    rows, columns = np.nonzero(edges)
    # The front face is 2 m ahead and 1 m wide: 50 px of 100 px per unit of tangent, around the centre.
    assert {rows.min(), columns.min()} <= {74, 75} and {rows.max(), columns.max()} <= {124, 125, 126}
    assert not edges[80:120, 80:120].any() and edges[100, 73:78].any() and edges[100, 123:128].any()
