"""The lists of gloam.distribute's folders, and what it refuses; no cluster is started."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gloam
import pytest
from gloam import distribute
from gloam._distribute.jobs import Failure, RolloutJob, SceneSource, work
from gloam._distribute.manifest import Manifest, publish, read_task

from distribute_fixtures import states, throw, write_ball


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return write_ball(tmp_path)


def _manifest(
    out: Path, seeds: list[int], request: Mapping[str, Any] | None = None, overwrite: bool = False
) -> Manifest:
    return Manifest(out, "test", request or {"a": 1}, seeds, overwrite)


def _finish(out: Path, name: str, seed: int) -> None:
    assert work(lambda folder, _: (folder.mkdir(), {})[1], str(out), name, seed, 1) is None


def test_list_goes_on_with_what_is_missing(tmp_path: Path) -> None:
    first = _manifest(tmp_path / "out", [5, 6, 7])
    _finish(first.out, "0001", 6)
    (first.out / ".part-0002-abc").mkdir()  # of a worker that died
    first.write()
    assert states(first.out) == ["waiting", "done", "waiting"]
    first.close()
    again = _manifest(tmp_path / "out", [5, 6, 7, 8])
    assert again.missing() == [0, 2, 3] and not list(again.out.glob(".part-*"))
    again.errors[0] = "why"
    again.write()
    assert states(again.out) == ["failed", "done", "waiting", "waiting"]
    again.close()


def test_list_of_another_request_is_left_alone(tmp_path: Path) -> None:
    _manifest(tmp_path, [1]).close()
    with pytest.raises(gloam.UsageError, match="another request"):
        _manifest(tmp_path, [1], {"a": 2})
    _manifest(tmp_path, [1]).close()


def test_seeds_of_another_call_are_not_taken_for_its_own(tmp_path: Path) -> None:
    first = _manifest(tmp_path, [1])
    _finish(tmp_path, "0000", 1)
    first.close()
    with pytest.raises(gloam.UsageError, match="created with seed 1, not 9"):
        _manifest(tmp_path, [9])
    _manifest(tmp_path, [9], overwrite=True).close()
    assert not (tmp_path / "0000").exists()


def test_a_strangers_folder_is_never_taken_or_removed(tmp_path: Path) -> None:
    (tmp_path / "0000").mkdir()
    (tmp_path / "0000" / "thesis.txt").write_text("years of work")
    for overwrite in (False, True):
        with pytest.raises(gloam.UsageError, match="was not created by a task"):
            _manifest(tmp_path, [1], overwrite=overwrite)
    assert (tmp_path / "0000" / "thesis.txt").exists()


def test_one_call_at_a_time(tmp_path: Path) -> None:
    first = _manifest(tmp_path, [1])
    with pytest.raises(gloam.UsageError, match="is in use by another process"):
        _manifest(tmp_path, [1])
    first.close()
    _manifest(tmp_path, [1]).close()


@pytest.mark.parametrize(
    "text, says", [("{", "damaged"), ("[]", "not a list of tasks"), ('{"tasks": 3}', "not a list of tasks")]
)
def test_damaged_lists(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "manifest.json").write_text(text)
    with pytest.raises(gloam.InputError, match=says):
        _manifest(tmp_path, [1])


def test_damaged_task(tmp_path: Path) -> None:
    (tmp_path / "0000").mkdir()
    (tmp_path / "0000" / "task.json").write_text('{"seed": ')
    with pytest.raises(gloam.InputError, match="damaged.*run again"):
        _manifest(tmp_path, [1])


def test_of_two_workers_the_first_one_counts(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "task.json").write_text(json.dumps({"seed": 1, "by": name}))
    assert publish(tmp_path / "a", tmp_path / "0000") and not publish(tmp_path / "b", tmp_path / "0000")
    assert read_task(tmp_path / "0000") == {"seed": 1, "by": "a"}


def test_a_task_that_fails_leaves_nothing(tmp_path: Path) -> None:
    def job(folder: Path, seed: int) -> dict[str, Any]:
        folder.mkdir()
        (folder / "half").touch()
        raise gloam.InputError("no", "x.toml", 3)

    assert work(job, str(tmp_path), "0000", 1, 1) == Failure("x.toml:3: no")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "arguments, says",
    [
        ({"count": 0}, "of at least 1"),
        ({"count": True}, "of at least 1"),
        ({"count": 2, "seeds": [1]}, "got 1 seeds for 2"),
        ({"count": 2, "seeds": [1, 1]}, "twice"),
        ({"count": 1, "seeds": -1}, "from 0 to 2"),
        ({"count": 1, "seeds": [2**64]}, "from 0 to 2"),
    ],
)
def test_wrong_seeds(scene: Path, tmp_path: Path, arguments: dict[str, Any], says: str) -> None:
    with pytest.raises(gloam.UsageError, match=says):
        distribute.rollouts(scene, throw, out=tmp_path / "out", **arguments)


def test_wrong_arguments(scene: Path, tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="a gloam.Policy or a function"):
        distribute.rollouts(scene, None, 1, out=tmp_path / "out")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a scene must be a path"):
        distribute.rollouts(None, throw, 1, out=tmp_path / "out")
    with pytest.raises(gloam.UsageError, match="none.toml cannot be read"):
        distribute.rollouts(tmp_path / "none.toml", throw, 1, out=tmp_path / "out")
    with pytest.raises(gloam.UsageError, match="none.mcap cannot be read"):
        distribute.variants(tmp_path / "none.mcap", tmp_path / "skies.toml", 1, tmp_path / "out")


def test_without_ray_the_error_says_what_to_install(
    scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(ImportError, match="pip install ray"):
        distribute.rollouts(scene, throw, 1, out=tmp_path / "out")


def test_results_that_no_file_holds(scene: Path, tmp_path: Path) -> None:
    def job(result: Any) -> str:
        made = work(RolloutJob(SceneSource(str(scene)), lambda *_: result), str(tmp_path), "0000", 1, 1)
        assert made is not None
        return made.error

    assert "cannot be written" in job({"x": float("nan")}) and "cannot be written" in job({"x": object()})
    assert "must return a dict or None, got a int" in job(3)
