"""Whole comparisons: the page and its numbers, degenerate sets, interruptions, and hostile files."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from gloam.real.compare import REAL, Comparison, Request, examine
from gloam.real.report import write_report
from gloam.real.summary import HALVES, Line, summarize
from PIL import Image
from real_fixtures import picture, write_network, write_set
from real_recompute import differences


@pytest.fixture(scope="module")
def network(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_network(tmp_path_factory.mktemp("network"))


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    root = tmp_path_factory.mktemp("images")
    return {
        REAL: write_set(root / "real", 14),
        "simulation": write_set(root / "sim", 14, noise=1.0, brightness=-15),
        "flat": write_set(root / "flat", 12, seed=50, noise=0.0),
    }


def compare(out: Path, network: Path, folders: dict[str, Path], **changed: Any) -> tuple[Comparison, dict[str, Line]]:
    others = {name: folder for name, folder in folders.items() if name != REAL}
    found = examine(Request(folders[REAL], others, (network,), **changed), out)
    lines, _ = summarize(found)
    return found, {line.name: line for line in lines}


def values(line: Line) -> dict[str, float | None]:
    return {key: estimate.value for key, estimate in line.measures.items()}


@pytest.mark.parametrize("is_paired", [True, False])
def test_the_page_has_the_numbers_of_the_raw_files(tmp_path: Path, network: Path, folders: dict[str, Path], is_paired: bool) -> None:
    others = {name: folder for name, folder in folders.items() if name != REAL}
    found = examine(Request(folders[REAL], others, (network,), is_paired, temperature=1.5, examples=2), tmp_path)
    files = {file.name for file in write_report(found)}
    assert files >= {"report.html", "images.csv", "summary.csv", "differences.csv", "summary.json"} and ("pairs.csv" in files) == is_paired
    assert differences(tmp_path) == []
    page = (tmp_path / "report.html").read_text()
    lines, _ = summarize(found)
    for line in lines:
        for key, estimate in line.measures.items():
            shown = re.search(f'data-set="{line.name}" data-network="small" data-measure="{key}"><b>([^<]*)</b>', page)
            # Likeness is printed in a table without network, of the first one.
            assert shown or key in ("flip", "ssim"), (line.name, key)
            if shown and estimate.value is not None:
                assert float(shown[1].replace("−", "-")) == pytest.approx(estimate.value, abs=6e-4)
    assert {line.name for line in lines} == {"simulation", "flat", HALVES}
    assert "0.4679" in page and "&lt;b&gt;" in page or "<b>plant</b>" not in page
    outside = page.replace("http://www.w3.org", "").replace("http://creativecommons", "").replace("http://purl.org", "")
    assert "http://" not in outside and "https://" not in outside and "<script" not in page
    assert all(word in page for word in ("less noisy", "darker", "Grad-CAM of", "EigenCAM, small"))
    json.loads((tmp_path / "summary.json").read_text(), parse_constant=pytest.fail)


def test_a_changed_number_is_found(tmp_path: Path, network: Path, folders: dict[str, Path]) -> None:
    found = examine(Request(folders[REAL], {"simulation": folders["simulation"]}, (network,), True), tmp_path)
    write_report(found)
    file = tmp_path / "pairs.csv"
    rows = file.read_text().splitlines()
    cells = rows[1].split(",")
    cells[rows[0].split(",").index("kl")] = "0.9"
    file.write_text("\n".join([rows[0], ",".join(cells), *rows[2:]]) + "\n")
    assert any("kl" in line for line in differences(tmp_path))


def test_equal_images(tmp_path: Path, network: Path, folders: dict[str, Path]) -> None:
    _, lines = compare(tmp_path, network, {REAL: folders[REAL], "simulation": folders[REAL]}, is_paired=True)
    found = values(lines["simulation"])
    for key in ("cosine_of_means", "cosine", "grad_overlap", "grad_iou", "eigen_overlap", "eigen_iou", "ssim"):
        assert found[key] == pytest.approx(1), key
    for key in ("kl_of_means", "kl", "fid", "flip"):
        assert found[key] == pytest.approx(0, abs=1e-6), key
    assert found["kid"] is not None and found["kid"] < 0, "the unbiased estimate of equal sets is below zero"


def test_one_image_has_no_distances_of_sets(tmp_path: Path, network: Path) -> None:
    folders = {REAL: write_set(tmp_path / "a", 1), "simulation": write_set(tmp_path / "b", 1, seed=9)}
    found, lines = compare(tmp_path / "out", network, folders, is_paired=True)
    numbers = values(lines["simulation"])
    assert numbers["fid"] is None and numbers["kid"] is None and numbers["cosine"] is not None and numbers["flip"] is not None
    assert lines["simulation"].measures["cosine"].low is None and HALVES not in lines
    write_report(found)
    page = (tmp_path / "out" / "report.html").read_text()
    assert "a single image has no FID or KID" in page and "The smallest set has 1 image" in page
    assert differences(tmp_path / "out") == []


def test_images_of_different_sizes(tmp_path: Path, network: Path) -> None:
    folders = {REAL: write_set(tmp_path / "a", 4), "simulation": write_set(tmp_path / "b", 2, size=(32, 24))}
    Image.fromarray(picture(2, (50, 50))).save(folders["simulation"] / "002.png")
    found, lines = compare(tmp_path / "out", network, folders, is_paired=True)
    assert len(found.pairs["simulation"]) == 3 and lines["simulation"].measures["flip"].count == 2, "one pair has another aspect ratio"
    assert lines["simulation"].measures["cosine"].count == 3
    write_report(found)
    page = (tmp_path / "out" / "report.html").read_text()
    assert "64 x 48 and 50 x 50 pixels have different aspect ratios" in page and "The images have different sizes" in page
    assert "1 image of “real” without a partner" in page


def test_without_network_and_with_two(tmp_path: Path, network: Path, folders: dict[str, Path]) -> None:
    pair = {name: folders[name] for name in (REAL, "simulation")}
    none = examine(Request(pair[REAL], {"simulation": pair["simulation"]}, (), True), tmp_path / "none")
    lines, _ = summarize(none)
    assert set(lines[0].measures) == {"flip", "ssim"} and len(lines) == 1
    write_report(none)
    assert "No network was used" in (tmp_path / "none" / "report.html").read_text()
    other = write_network(tmp_path / "other", 8, "other")
    two = examine(Request(pair[REAL], {"simulation": pair["simulation"]}, (network, other), True), tmp_path / "two")
    write_report(two)
    assert differences(tmp_path / "two") == []
    with pytest.raises(gloam.UsageError, match="two networks have one name"):
        examine(Request(pair[REAL], {"simulation": pair["simulation"]}, (network, network)), tmp_path / "twice")


def cached(out: Path) -> dict[Path, int]:
    return {file: file.stat().st_mtime_ns for file in out.glob("cache/*/*/*.npz")}


def test_a_killed_comparison_continues(tmp_path: Path, network: Path, folders: dict[str, Path]) -> None:
    code = (
        "import sys, time\nfrom pathlib import Path\nimport gloam.real.compare as c\nrun = c.Network.run\n"
        "def slow(self, image):\n    time.sleep(0.05)\n    return run(self, image)\nc.Network.run = slow\n"
        f"c.examine(c.Request(Path({str(folders[REAL])!r}), {{'simulation': Path({str(folders['simulation'])!r})}}, "
        f"(Path({str(network)!r}),), True), Path(sys.argv[1]))"
    )
    out = tmp_path / "out"
    process = subprocess.Popen([sys.executable, "-c", code, str(out)])
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and len(list(out.glob("cache/network-*/*/*.npz"))) < 3:
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    process.wait()
    kept = cached(out)
    assert 3 <= len([file for file in kept if "network-" in str(file)]) < 28
    first = next(file for file in kept if "network-" in str(file))
    first.write_bytes(first.read_bytes()[:100])  # as after a power failure
    del kept[first]
    pair = {name: folders[name] for name in (REAL, "simulation")}
    _, again = compare(out, network, pair, is_paired=True)
    assert all(cached(out)[file] == stamp for file, stamp in kept.items()), "examined once"
    fresh, lines = compare(tmp_path / "fresh", network, pair, is_paired=True)
    assert {key: values(line) for key, line in lines.items()} == {key: values(line) for key, line in again.items()}
    page = write_report(fresh)[-1].read_text()
    assert page == write_report(fresh)[-1].read_text(), "the same page each time"


def test_another_process_in_the_folder(tmp_path: Path, network: Path, folders: dict[str, Path]) -> None:
    from gloam.experiments.files import locked

    with locked(tmp_path), pytest.raises(gloam.UsageError, match="in use"):
        compare(tmp_path, network, folders)


def test_hostile_files_are_left_out(tmp_path: Path, network: Path) -> None:
    real, sim = write_set(tmp_path / "real", 4), write_set(tmp_path / "sim", 4, seed=20)
    (sim / "text.png").write_text("not an image")
    (sim / "short.png").write_bytes((real / "000.png").read_bytes()[:200])
    Image.new("1", (30_000, 30_000)).save(sim / "bomb.png")
    Image.new("1", (9000, 8000)).save(sim / "large.png")
    Image.new("RGB", (8, 8)).save(sim / "tiny.png")
    (sim / "link.png").symlink_to("/etc/passwd")
    (sim / "folder.png").symlink_to(real)
    os.mkfifo(sim / "pipe.png")
    (sim / "notes.txt").write_text("ignored")
    odd = '<img src=x onerror=alert(1)>"&\n.png'
    shutil.copy(real / "000.png", sim / odd)
    shutil.copy(real / "001.png", os.fsencode(sim) + b"/\xff\xfe.png")
    begin = time.monotonic()
    found, lines = compare(tmp_path / "out", network, {REAL: real, "simulation": sim})
    assert time.monotonic() - begin < 30 and lines["simulation"].count == 6
    reasons = dict(found.sets["simulation"].left_out)
    assert set(reasons) == {"text.png", "short.png", "bomb.png", "large.png", "tiny.png", "link.png", "folder.png", "pipe.png"}
    assert (
        all("more than 64 Mi" in reasons[name] for name in ("bomb.png", "large.png"))
        and "link" in reasons["link.png"]
        and "16 or more" in reasons["tiny.png"]
    )
    write_report(found)
    page = (tmp_path / "out" / "report.html").read_text()
    assert "<img src=x" not in page and "passwd" not in page and "bomb.png" in page


def test_a_full_disk_is_an_error(tmp_path: Path, network: Path, folders: dict[str, Path], monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: Any, **__: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez", full)
    with pytest.raises(gloam.IoError, match="No space left"):
        compare(tmp_path, network, folders)
    assert not list(tmp_path.glob("cache/*/*/*"))


def test_an_image_that_changes_meanwhile(tmp_path: Path, network: Path) -> None:
    folders = {REAL: write_set(tmp_path / "a", 3), "simulation": write_set(tmp_path / "b", 3, seed=5)}
    found, _ = compare(tmp_path / "out", network, folders)
    Image.fromarray(picture(77)).save(folders[REAL] / "000.png")
    with pytest.raises(gloam.IoError, match="has changed"):
        write_report(found)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"temperature": 0.0}, "temperature"),
        ({"smoothing": 0.0}, "smoothing"),
        ({"most": 0}, "1 to 1000000 images"),
        ({"class_number": 5}, "no class 5: there are 5"),
        ({"class_number": -1}, "no class -1"),
        ({"others": {"a/b": Path("x")}}, "name of a folder"),
    ],
)
def test_wrong_requests(tmp_path: Path, network: Path, folders: dict[str, Path], changed: dict[str, Any], words: str) -> None:
    request = {"others": {"simulation": folders["simulation"]}, "networks": (network,), **changed}
    with pytest.raises(gloam.UsageError, match=words):
        examine(Request(folders[REAL], **request), tmp_path / "out")


def test_wrong_folders(tmp_path: Path, network: Path, folders: dict[str, Path]) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / "a.png").write_text("x")
    for folder, kind, words in (
        ("none", gloam.IoError, "no such folder"),
        ("empty", gloam.InputError, "no images"),
        ("bad", gloam.InputError, "none of its 1"),
    ):
        with pytest.raises(kind, match=words):
            compare(tmp_path / "out", network, {REAL: folders[REAL], "simulation": tmp_path / folder})
    other = write_set(tmp_path / "other", 2)
    shutil.copy(other / "000.png", other / "000.bmp")
    with pytest.raises(gloam.UsageError, match=r"one image per name, but there are 000\.bmp and 000\.png"):
        compare(tmp_path / "out", network, {REAL: folders[REAL], "simulation": other}, is_paired=True)
    renamed = tmp_path / "renamed"
    renamed.mkdir()
    shutil.copy(other / "000.png", renamed / "view.png")
    with pytest.raises(gloam.UsageError, match="no file names match"):
        compare(tmp_path / "out", network, {REAL: folders[REAL], "simulation": renamed}, is_paired=True)


def test_most_chooses_the_same_images_each_time(tmp_path: Path, network: Path, folders: dict[str, Path]) -> None:
    pair = {name: folders[name] for name in (REAL, "simulation")}
    first, _ = compare(tmp_path / "a", network, pair, most=5)
    again, _ = compare(tmp_path / "b", network, pair, most=5)
    names = [[picture.name for picture in one.sets[REAL].pictures] for one in (first, again)]
    assert names[0] == names[1] and len(names[0]) == 5 and first.sets[REAL].skipped == 9
    paired, _ = compare(tmp_path / "c", network, pair, most=5, is_paired=True)
    assert len(paired.pairs["simulation"]) == 5


@pytest.mark.slow
def test_many_images_in_bounded_memory(tmp_path: Path, network: Path, run_python: Any) -> None:
    """Thousands of images in 300 MB above an empty process: neither images nor features are kept."""
    for name in ("real", "sim"):
        folder = write_set(tmp_path / name, 20, seed=len(name), size=(32, 24))
        data = [file.read_bytes() for file in sorted(folder.iterdir())]
        for k in range(6000):
            (folder / f"copy_{k:05}.png").write_bytes(data[k % 20])
    code = (
        "import resource\nfrom pathlib import Path\nfrom gloam.real.compare import Request, examine\n"
        "from gloam.real.report import write_report\n"
        "import matplotlib.figure, jinja2, openvino, onnx\nbefore = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
        f"root = Path({str(tmp_path)!r})\n"
        f"write_report(examine(Request(root / 'real', {{'simulation': root / 'sim'}}, (Path({str(network)!r}),)), root / 'out'))\n"
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)"
    )
    told = run_python(code, timeout=600)
    assert int(told.stdout) < 300_000, told.stdout
