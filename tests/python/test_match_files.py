"""Files of gloam match: pairs, photographs, masks, and the scene with the solved camera."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from match_scenes import drawn, room
from PIL import Image, ImageCms

import gloam
from gloam.match.camera import Lens
from gloam.match.pairs import Pair, read_pairs, scene_points, write_pairs
from gloam.match.photo import from_srgb, load_mask, load_photo, to_srgb
from gloam.match.scene_file import camera_text, matched_table, write_scene
from gloam.match.solve import Solution, solve
from gloam.match.view import camera_table, scene_with


def solution(seed: int = 1) -> Solution:
    camera, points, pixels = drawn(seed, 9)
    return solve(pixels, points, camera.lens)


# ---- pairs ----
def test_pairs_survive_their_file(tmp_path: Path) -> None:
    pairs = [
        Pair('a "quoted" name', (1.25, 0.0), (0.1, -2.0, 3.5)),
        Pair("corner", (640.0, 480.0), None, "geom", "table/top", "+-0"),
        Pair("mark", (3.0, 4.0), None, "site", "mark"),
    ]
    assert read_pairs(write_pairs(tmp_path / "pairs.toml", pairs)) == pairs


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "consists of \\[\\[pair\\]\\] tables"),
        ("pair = 3", "consists of \\[\\[pair\\]\\] tables"),
        ("[[pair]]\npixel = [1, 2]\n", "pair 1: give one of point, geom, body, site, got none"),
        ('[[pair]]\npixel = [1, 2]\npoint = [0, 0, 0]\nbody = "x"\n', "pair 1: give one of .*, got point and body"),
        ("[[pair]]\npixel = [1]\npoint = [0, 0, 0]\n", "pair 1: pixel must be two finite numbers"),
        ("[[pair]]\npixel = [1, nan]\npoint = [0, 0, 0]\n", "pair 1: pixel must be two finite numbers"),
        ("[[pair]]\npixel = [1, true]\npoint = [0, 0, 0]\n", "pair 1: pixel must be two finite numbers"),
        ("[[pair]]\npixel = [1, 2]\npoint = [0, 0, inf]\n", "pair 1: point must be three finite numbers"),
        ("[[pair]]\npixel = [1, 2]\npoint = [0, 0, 1e300]\n", "pair 1: point must be three finite numbers"),
        ("[[pair]]\npixel = [1, 2]\npoint = [0, 0, 0]\npxel = 1\n", "pair 1: unknown key 'pxel'"),
        ('[[pair]]\npixel = [1, 2]\ngeom = "a"\ncorner = "++x"\n', "pair 1: corner has three signs"),
        ('[[pair]]\npixel = [1, 2]\nbody = "a"\ncorner = "+++"\n', "pair 1: corner has three signs"),
        ("[[pair]]\npixel = [1, 2]\nbody = 7\n", "pair 1: body must be a name"),
        ('[[pair]]\nname = "\\u001b[2J"\npixel = [1, 2]\npoint = [0, 0, 0]\n', "pair 1: name must be a text .* printable"),
        ("[[pair]\n", "not valid TOML"),
        ("a = " + "[" * 5000, "not valid TOML"),
    ],
)
def test_malformed_pairs_are_rejected(tmp_path: Path, text: str, problem: str) -> None:
    file = tmp_path / "pairs.toml"
    file.write_text(text)
    with pytest.raises(gloam.InputError, match=problem):
        read_pairs(file)


def test_files_that_are_no_pairs_are_rejected(tmp_path: Path) -> None:
    with pytest.raises(gloam.IoError, match="cannot read the pairs"):
        read_pairs(tmp_path / "missing.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00" * 10)
    with pytest.raises(gloam.InputError, match="not valid TOML"):
        read_pairs(tmp_path / "binary.toml")
    (tmp_path / "many.toml").write_text("[[pair]]\npixel = [1, 2]\npoint = [0, 0, 0]\n" * 501)
    with pytest.raises(gloam.InputError, match="501 pairs; at most 500"):
        read_pairs(tmp_path / "many.toml")
    (tmp_path / "large.toml").write_bytes(b"#" * (2 << 20))
    with pytest.raises(gloam.InputError, match="at most 1 MiB"):
        read_pairs(tmp_path / "large.toml")


def test_elements_have_their_points(tmp_path: Path) -> None:
    """Closed forms: the table stands at (0.6, 0.5), its top has half sizes of 0.6, 0.4 and 0.02 at 0.72."""
    pairs = [
        Pair("", (0, 0), None, "geom", "top", "+-+"),
        Pair("", (0, 0), None, "geom", "top"),
        Pair("", (0, 0), None, "body", "table"),
        Pair("", (0, 0), None, "site", "mark"),
        Pair("", (0, 0), None, "geom", "can", "00+"),
        Pair("", (0, 0), None, "geom", "box", "+00"),
        Pair("", (0, 0), (1.0, 2.0, 3.0)),
    ]
    turn = np.radians(25)
    expected = [
        (1.2, 0.1, 0.74), (0.6, 0.5, 0.72), (0.6, 0.5, 0), (0.2, 0.3, 0.74), (0.8, 0.6, 0.94),
        (-1.2 + 0.25 * np.cos(turn), 1.2 + 0.25 * np.sin(turn), 0.3), (1, 2, 3),
    ]  # fmt: skip
    with gloam.load(room(tmp_path)) as sim:
        np.testing.assert_allclose(scene_points(sim, pairs), expected, atol=1e-12)
        with pytest.raises(gloam.NotFoundError, match="no geom 'tpo'.*did you mean"):
            scene_points(sim, [Pair("a", (0, 0), None, "geom", "tpo")])
        with pytest.raises(gloam.InputError, match="round"):
            scene_points(sim, [Pair("a", (0, 0), None, "geom", "can", "+0+")])


# ---- photographs ----
def test_exif_orientation_turns_the_photograph(tmp_path: Path) -> None:
    """All eight orientations of the same upright picture."""
    upright = np.zeros((40, 60, 3), dtype=np.uint8)
    upright[:20, :30] = [250, 10, 10]
    upright[20:, 30:] = [10, 10, 250]
    stored = {
        1: upright, 2: upright[:, ::-1], 3: upright[::-1, ::-1], 4: upright[::-1], 5: upright.transpose(1, 0, 2),
        6: np.rot90(upright), 7: upright[::-1, ::-1].transpose(1, 0, 2), 8: np.rot90(upright, -1),
    }  # fmt: skip
    for orientation, image in stored.items():
        exif = Image.Exif()
        exif[0x0112] = orientation
        file = tmp_path / f"{orientation}.png"
        Image.fromarray(np.ascontiguousarray(image)).save(file, exif=exif)
        photo = load_photo(file)
        assert (photo.width, photo.height) == (60, 40), orientation
        np.testing.assert_array_equal(photo.image, upright, err_msg=str(orientation))


def png(width: int, height: int, data: bytes) -> bytes:
    """A PNG of 8-bit grey with any header."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


@pytest.mark.parametrize(("width", "height"), [(60000, 60000), (12000, 8000), (20000, 10)])
def test_huge_photographs_are_rejected_before_they_are_decoded(tmp_path: Path, width: int, height: int) -> None:
    file = tmp_path / "bomb.png"
    file.write_bytes(png(width, height, zlib.compress(bytes(1000))))
    with pytest.raises(gloam.InputError, match="^[^ ]*: the photograph (is too large|has .* are accepted)"):
        load_photo(file)


def test_files_that_are_no_photographs_are_rejected(tmp_path: Path) -> None:
    with pytest.raises(gloam.IoError, match="cannot read the photograph: No such file"):
        load_photo(tmp_path / "missing.jpg")
    with pytest.raises(gloam.IoError, match="directory"):
        load_photo(tmp_path)
    (tmp_path / "text.jpg").write_text("not an image")
    with pytest.raises(gloam.InputError, match="not an image"):
        load_photo(tmp_path / "text.jpg")
    (tmp_path / "cut.png").write_bytes(png(100, 100, zlib.compress(bytes(10100))[:20]))
    with pytest.raises(gloam.InputError, match="damaged"):
        load_photo(tmp_path / "cut.png")
    Image.fromarray(np.zeros((4, 4), dtype=np.uint16)).save(tmp_path / "deep.png")
    with pytest.raises(gloam.InputError, match="convert it to 8 bits"):
        load_photo(tmp_path / "deep.png")


@pytest.mark.parametrize("mode", ["L", "RGBA", "P", "CMYK", "1"])
def test_kinds_of_pixels_become_colours(tmp_path: Path, mode: str) -> None:
    file = tmp_path / "photo.tiff"
    Image.new("RGB", (8, 6), (255, 255, 255)).convert(mode).save(file)
    np.testing.assert_array_equal(load_photo(file).image, np.full((6, 8, 3), 255, dtype=np.uint8))


@pytest.mark.parametrize("profile", [ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes(), b"no profile"])
def test_profiles_of_the_colours_of_screens_and_damaged_ones_change_nothing(tmp_path: Path, profile: bytes) -> None:
    image = np.random.default_rng(0).integers(0, 256, (8, 8, 3), dtype=np.uint8)
    Image.fromarray(image).save(tmp_path / "photo.png", icc_profile=profile)
    assert np.abs(load_photo(tmp_path / "photo.png").image.astype(int) - image).max() <= 1


def test_srgb_is_inverted() -> None:
    levels = np.arange(256, dtype=np.uint8)
    np.testing.assert_array_equal(to_srgb(from_srgb(levels / 255)), levels)
    assert from_srgb(np.array([118 / 255]))[0] == pytest.approx(0.18, abs=0.002)  # docs/light.md


def test_light_is_averaged_as_light_and_clipped_blocks_are_marked(tmp_path: Path) -> None:
    image = np.full((20, 20, 3), 100, dtype=np.uint8)
    image[:10, :10:2] = 200
    image[15, 15] = 255
    Image.fromarray(image).save(tmp_path / "a.png")
    light, usable = load_photo(tmp_path / "a.png").light(2, 2)
    mean = (from_srgb(np.array(200 / 255)) + from_srgb(np.array(100 / 255))) / 2
    np.testing.assert_allclose(light[0, 0], mean, rtol=1e-4)
    np.testing.assert_array_equal(usable, [[True, True], [True, False]])


def test_masks_have_the_size_of_the_photograph(tmp_path: Path) -> None:
    Image.new("RGB", (8, 6)).save(tmp_path / "photo.png")
    Image.fromarray(np.array([[0, 255]] * 3, dtype=np.uint8).repeat(4, axis=1).repeat(2, axis=0)).save(tmp_path / "mask.png")
    photo = load_photo(tmp_path / "photo.png")
    assert load_mask(tmp_path / "mask.png", photo).sum() == 24
    Image.new("L", (8, 7)).save(tmp_path / "other.png")
    with pytest.raises(gloam.InputError, match="mask has 8 x 7 pixels, the photograph 8 x 6"):
        load_mask(tmp_path / "other.png", photo)


# ---- scenes ----
def test_the_scene_keeps_its_text_and_gets_the_camera(tmp_path: Path) -> None:
    scene, found = room(tmp_path), solution()
    before = scene.read_text()
    text = camera_text(matched_table("photo", found, None), found, None, "a\nname.jpg")
    written = write_scene(scene, text, tmp_path / "matched.toml")
    assert written.read_text().startswith(before) and scene.read_text() == before
    with gloam.load(written) as sim:
        pose = sim.cameras["photo"].render(("depth",), width=64, height=48, tier="direct", spp=1).pose
    np.testing.assert_allclose(pose.p, found.camera.p, atol=1e-8)
    np.testing.assert_allclose(np.abs(pose.q @ found.camera.quaternion), 1, atol=1e-8)
    write_scene(scene, text, scene)  # in place
    assert "photo" in gloam.Scene(scene).compile().cameras


def test_a_second_camera_of_the_name_is_rejected(tmp_path: Path) -> None:
    scene, found = room(tmp_path), solution()
    text = camera_text(matched_table("rough", found, None), found, None, "photo.jpg")
    with pytest.raises(gloam.InputError, match="rough"):
        write_scene(scene, text, tmp_path / "matched.toml")
    assert not (tmp_path / "matched.toml").exists()
    with pytest.raises(gloam.UsageError, match="already exists"):
        scene_with(gloam.Scene(scene), camera_table("rough", found.camera))


def test_a_copy_elsewhere_that_misses_its_files_is_rejected(tmp_path: Path) -> None:
    scene, found = room(tmp_path), solution()
    (tmp_path / "elsewhere").mkdir()
    text = camera_text(matched_table("photo", found, None), found, None, "photo.jpg")
    with pytest.raises(gloam.InputError, match="write it beside"):
        write_scene(scene, text, tmp_path / "elsewhere" / "matched.toml")


def test_a_bare_model_becomes_the_environment_of_a_scene(tmp_path: Path) -> None:
    room(tmp_path)
    found = solution()
    text = camera_text(matched_table("photo", found, None), found, None, "photo.jpg")
    written = write_scene(tmp_path / "room.xml", text, tmp_path / "matched.toml")
    assert "table" in gloam.Scene(written).compile().bodies


def test_the_field_of_view_of_a_lens_is_that_of_its_focal_length() -> None:
    lens = Lens.of_fovy(640, 480, 90)
    assert lens.f == pytest.approx(240) and lens.fovy == pytest.approx(90)


def test_the_pinned_packages_are_those_of_the_tests() -> None:
    """The tests' environment has the packages with which ./gloam match runs."""
    root = Path(__file__).resolve().parents[2]

    def pins(name: str) -> set[str]:
        return {line.split()[0] for line in (root / name).read_text().splitlines() if "==" in line}

    assert pins("tools/match/requirements.txt") <= pins("tools/navigation/requirements.txt") | pins("tests/python/requirements.txt")
