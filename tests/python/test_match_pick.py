"""The page on which a person picks pairs: its contents, and its use by mouse and keyboard in a browser."""

from __future__ import annotations

import base64
import json
import re
import time
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from e2e import browser
from e2e.browser import Browser
from match_scenes import room
from PIL import Image

import gloam
from gloam.match.pairs import Pair, read_pairs, scene_points
from gloam.match.photo import load_photo
from gloam.match.pick import Rough, write_pick_page
from gloam.match.view import Quality

QUICK = Quality(320, "direct", 1)
PAIRS = [Pair("</script><b>", (12.5, 20.0), (0.0, 0.0, 0.5)), Pair("corner", (40.0, 30.0), None, "geom", "top", "+-+")]


@pytest.fixture
def page(tmp_path: Path) -> Path:
    image = np.zeros((150, 200, 3), dtype=np.uint8)
    image[50:100, 60:140] = [200, 120, 40]
    Image.fromarray(image).save(tmp_path / "photo.png")
    return write_pick_page(load_photo(tmp_path / "photo.png"), room(tmp_path), ("rough",), PAIRS, QUICK, tmp_path / "pick.html")


def state_of(page: Path) -> dict[str, Any]:
    found = re.search(r'<script type="application/json" id="state">(.*?)</script>', page.read_text(), re.S)
    assert found is not None
    state: dict[str, Any] = json.loads(found[1])
    return state


def test_the_page_needs_no_server_and_holds_exact_depth(page: Path, tmp_path: Path) -> None:
    text = page.read_text()
    assert "default-src 'none'" in text and not re.search(r"https?://|src=\"(?!data:)", text)
    state = state_of(page)
    assert state["photo"] == {"name": "photo.png", "width": 200, "height": 150}
    assert [pair["name"] for pair in state["pairs"]] == ["</script><b>", "corner"]
    np.testing.assert_allclose(state["pairs"][1]["point"], [1.2, 0.1, 0.74], atol=1e-9)
    view = state["views"][0]
    depth = np.frombuffer(zlib.decompress(base64.b64decode(view["depth"])), dtype="<f4").reshape(view["height"], view["width"])
    y, x = np.mgrid[: view["height"], : view["width"]] + 0.5
    rays = np.stack([(x - view["centre"][0]) / view["f"][0], (y - view["centre"][1]) / view["f"][1], np.ones_like(x)], axis=2)
    points = rays * depth[:, :, None] @ np.array(view["R"]).T + view["p"]
    # Every point lies on a surface of the room: all are within it, and the floor and the walls are planes of it.
    assert (np.abs(points[:, :, :2]) < 2.9501).all() and (points[:, :, 2] > -1e-4).all()
    assert np.mean(np.abs(points[:, :, 2]) < 1e-4) > 0.2 and np.mean(np.abs(points[:, :, 1] - 2.95) < 1e-4) > 0.05


def test_views_of_rough_and_unknown_cameras(tmp_path: Path) -> None:
    Image.new("RGB", (40, 30)).save(tmp_path / "photo.png")
    photo, scene, out = load_photo(tmp_path / "photo.png"), room(tmp_path), tmp_path / "pick.html"
    write_pick_page(photo, scene, Rough((-1.0, -2.0, 1.5), (0.5, 0.5, 0.5), 70), [], QUICK, out)
    np.testing.assert_allclose(state_of(out)["views"][0]["p"], [-1, -2, 1.5])
    write_pick_page(photo, tmp_path / "room.xml", (), [], QUICK, out)
    assert [view["name"] for view in state_of(out)["views"]] == ["free"]
    with pytest.raises(gloam.NotFoundError, match="no camera 'ruogh'.*rough"):
        write_pick_page(photo, scene, ("ruogh",), [], QUICK, out)
    with pytest.raises(gloam.UsageError, match="another point"):
        write_pick_page(photo, scene, Rough((0.0, 0.0, 1.0), (0.0, 0.0, 1.0)), [], QUICK, out)


@pytest.fixture
def opened(page: Path) -> Iterator[Browser]:
    if not browser.find():
        pytest.skip("there is no Chromium on this machine")
    made = Browser(1200, 800)
    try:
        made.open(page.as_uri())
        made.wait("document.getElementById('message')?.innerText.startsWith('Click')")
        yield made
        assert made.problems == []
    finally:
        made.close()


def click(view: Browser, pane: str, x: float, y: float) -> None:
    """Clicks a pixel of a pane's image."""
    at = view.value(f"(() => {{ const b = {pane}.canvas.getBoundingClientRect();"
                    f" return [b.left + {pane}.left + {x} * {pane}.zoom, b.top + {pane}.top + {y} * {pane}.zoom]; }})()")  # fmt: skip
    view.mouse("mouseMoved", *at, held=False)
    view.mouse("mousePressed", *at)
    view.mouse("mouseReleased", *at)


def saved(view: Browser, folder: Path) -> list[Pair]:
    view.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder))
    view.click("save")
    deadline = time.monotonic() + 15
    while not (folder / "pairs.toml").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    return read_pairs(folder / "pairs.toml")


def test_clicks_and_keys_make_pairs(opened: Browser, page: Path, tmp_path: Path) -> None:
    state = state_of(page)["views"][0]
    pose = np.array(state["R"]), np.array(state["p"])
    with gloam.load(room(tmp_path)) as sim:
        corner = scene_points(sim, [Pair("", (0, 0), None, "geom", "top", "0-+")])[0] + [0, 0.05, 0]  # on the table's top
    seen = pose[0].T @ (corner - pose[1])
    click(opened, "photo", 70.25, 60.5)
    assert "same point in the scene" in opened.text("message")
    click(opened, "scene", *(state["centre"] + state["f"] * seen[:2] / seen[2]))
    assert "3 pairs" in opened.text("count")
    # By keyboard: ten pixels to the right, two tenths down, in both panes.
    for pane in ("photo", "scene"):
        opened.value(f"{pane}.canvas.focus()")
        for _ in range(10):
            opened.key("ArrowRight")
        opened.key("Enter")
    assert "4 pairs" in opened.text("count")
    opened.value("document.querySelector('[aria-label=\"Delete pair 2\"]').click()")
    pairs = saved(opened, tmp_path)
    assert [pair.name for pair in pairs] == ["</script><b>", "pair 3", "pair 4"]
    assert pairs[0] == PAIRS[0]
    np.testing.assert_allclose(pairs[1].pixel, [70.25, 60.5], atol=0.6)
    assert pairs[1].point is not None
    np.testing.assert_allclose(pairs[1].point, corner, atol=0.02)
    assert pairs[1].point[2] == pytest.approx(0.74, abs=1e-4)  # on the plane between the pixel centres too
    assert pairs[2].pixel[0] == pytest.approx(pairs[1].pixel[0] + 10, abs=0.02)


def test_points_outside_are_refused_and_open_points_discarded(opened: Browser) -> None:
    opened.value("photo.canvas.focus()")
    opened.key("-", "-")
    click(opened, "photo", -3, 20)
    assert opened.text("message") == "That is outside the image."
    click(opened, "photo", 20, 20)
    opened.key("Escape")
    click(opened, "scene", 160, 200)
    assert "2 pairs" in opened.text("count") and "same point in the photograph" in opened.text("message")


def test_zoom_keeps_the_place_and_zero_shows_all(opened: Browser) -> None:
    before = opened.value("photo.zoom")
    opened.value("photo.canvas.focus()")
    for _ in range(4):
        opened.key("+", "+")
    assert opened.value("photo.zoom") == pytest.approx(before * 1.5**4)
    click(opened, "photo", 100.5, 75.5)
    np.testing.assert_allclose(opened.value("photo.open.pixel"), [100.5, 75.5], atol=0.1)
    opened.key("0", "0")
    assert opened.value("photo.zoom") == pytest.approx(before)
