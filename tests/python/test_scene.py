"""Scenes and options from Python."""
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import gloam
import pytest
from gloam import _toml
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import QUADRUPED, ROOT, ball_scene


def test_options_by_path(tmp_path: Path) -> None:
    scene = ball_scene(tmp_path)
    assert scene["sim.duration"] == 1.0
    scene["camera.small.width"] = 64
    assert scene["camera.small.width"] == 64 and scene["camera.small.position"] == [0.0, -3.0, 1.0]
    assert "sim.seed" in scene and "sim.sead" not in scene
    with pytest.raises(gloam.Error, match="did you mean 'duration'"):
        scene["sim.duratiom"] = 3
    with pytest.raises(KeyError):
        _ = scene["sim.duratiom"]
    with pytest.raises(TypeError, match="None"):
        scene["sim.duration"] = None
    with pytest.raises(gloam.Error):
        scene.update({"sim.duration": 5, "sim.nope": 1})
    assert scene["sim.duration"] == 1.0, "all or none"


def test_a_scene_in_code_is_that_of_a_file(tmp_path: Path) -> None:
    scene = gloam.Scene.parse("[sim]\nduration = 2\n[environment.hallway]\n", tmp_path)
    path = scene.add("camera", name="front", position=(2, 0, 1), look_at=[0, 0, 0])
    assert path == "camera.front" and scene["camera.front.position"] == [2.0, 0.0, 1.0]
    scene.add("weather", visibility=100)
    assert scene["weather.visibility"] == 100.0
    again = gloam.Scene.parse(scene.to_toml(), tmp_path)
    assert again.to_toml() == scene.to_toml()
    with pytest.raises(gloam.Error):
        scene.add("camera", name="front")
    with pytest.raises(gloam.Error, match="camera"):
        scene.add("camra", name="x")


def test_errors_name_file_and_line(tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    file.write_text("[sim]\nduration = 1\n\n[[robot]]\nname = 3\n")
    with pytest.raises(gloam.InputError) as raised:
        gloam.Scene(file)
    assert raised.value.line == 5 and raised.value.file.endswith("bad.toml")
    with pytest.raises(gloam.Error, match="no such file"):
        gloam.load(tmp_path / "none.toml")
    with pytest.raises(FileNotFoundError if False else OSError):
        gloam.load(tmp_path / "none.toml")


def test_worlds_tell_what_they_hold() -> None:
    world = gloam.Scene(QUADRUPED).compile()
    assert len(world.joints) == 13 and world.robots and world.timestep == 0.002
    assert any(topic.name == "/tf" for topic in world.topics())
    assert world.scene.compile().joints == world.joints


def test_every_option_of_the_examples_is_set_to_what_it_is() -> None:
    for example in ("demo", "adversity_house", "adversity_warehouse", "lidar", "pool", "rover"):
        scene = gloam.Scene(ROOT / "examples" / f"{example}.toml")
        before = scene.to_toml()
        for option in scene.options():
            if option.value is None:
                continue
            scene[option.path] = option.value
            assert scene[option.path] == option.value, option
        assert gloam.Scene.parse(scene.to_toml(), ROOT / "examples").options(), example
        assert _without_blanks(scene.to_toml()) >= _without_blanks(before)


def _without_blanks(text: str) -> set[str]:
    return {line.strip() for line in text.splitlines() if line.strip()}


def test_options_are_documented() -> None:
    scene = gloam.Scene(ROOT / "examples" / "adversity_house.toml")
    options = scene.options()
    documented = [o for o in options if o.doc]
    assert len(documented) > 0.9 * len(options), [o.path for o in options if not o.doc][:20]
    assert gloam.describe("weather.visibility")


_SCENE = gloam.Scene(ROOT / "examples" / "adversity_house.toml")
_NUMBERS = [o for o in _SCENE.options() if isinstance(o.value, float)]


@settings(max_examples=150, deadline=None)
@given(option=st.sampled_from(_NUMBERS), value=st.floats(allow_nan=True, allow_infinity=True))
def test_a_number_is_kept_exactly_or_refused(option: gloam.Option, value: float) -> None:
    scene = _SCENE.copy()
    try:
        scene[option.path] = value
    except gloam.Error:
        assert scene[option.path] == option.value
        return
    assert scene[option.path] == value and not math.isnan(value)


@settings(max_examples=200, deadline=None)
@given(path=st.sampled_from([o.path for o in _SCENE.options()]),
       value=st.recursive(st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
                          lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3), max_leaves=6))
def test_any_value_is_taken_or_refused_and_never_worse(path: str, value: Any) -> None:
    scene = _SCENE.copy()
    before = scene.to_toml()
    try:
        scene[path] = value
    except (gloam.Error, TypeError):
        assert scene.to_toml() == before


@given(st.text(max_size=40))
def test_texts_of_toml_come_back(text: str) -> None:
    try:
        written = _toml.to_text(text)
        assert _toml.from_text(written) == text
    except gloam.UsageError:
        assert any(0xD800 <= ord(c) < 0xE000 for c in text)
