"""Operation of `gloam bench nav`: options and plugins of planners, interruptions, kills, processes and cost."""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import gloam
import numpy as np
import pytest
from gloam.navigation.benchmark.cost import cost_lines
from gloam.navigation.benchmark.episode import EpisodeSpec
from gloam.navigation.benchmark.options import File, Option, arguments, completed, parse_options, plugin_files
from gloam.navigation.benchmark.places import EYE, ROBOT
from gloam.navigation.benchmark.pool import Died, local_results
from gloam.navigation.benchmark.request import Request
from gloam.navigation.benchmark.runner import Workers
from gloam.navigation.benchmark.visibility import PROBE, VisibilityMeter, visibility_probe
from gloam.navigation.planner import make_planner
from gloam.navigation.planners.external import ExternalPlanner
from gloam.navigation.planners.goal_image import own_weights
from gloam.navigation.plugins import load_plugin

from navigation_scene import arena

ROOT = Path(__file__).resolve().parents[2]
COMMANDS = ROOT / "tools/navigation/commands.py"
PLUGIN = Path(__file__).with_name("navigation_plugin.py")


def command(*arguments: str) -> int:
    """The exit code of `gloam bench nav` with the arguments, run in this process."""
    spec = importlib.util.spec_from_file_location("navigation_commands", COMMANDS)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return int(module.main(["bench", *arguments]))


def test_options_are_toml_or_text_or_files(tmp_path: Path) -> None:
    (tmp_path / "gnm.onnx").write_bytes(b"network")
    weights = tmp_path / "gnm.onnx"
    options = parse_options(
        [f"gnm.weights={weights}", "gnm.radius=2", "a.b.crop = false", "x.needs=[\"image\", \"scan\"]", "x.address=tcp://h:1",
         "x.when=2024-01-01", "x.far=inf", f"x.program={tmp_path / 'missing'}"]
    )  # fmt: skip
    assert {str(o): o.value for o in options} == {
        "gnm.weights": File(str(weights), "3009be769fb8f956e8413ee9f3e0836e34968bc40457d0a10c549d2edcf00cc1"),
        "gnm.radius": 2, "a.b.crop": False, "x.needs": ("image", "scan"), "x.address": "tcp://h:1",
        "x.when": "2024-01-01", "x.far": "inf", "x.program": str(tmp_path / "missing"),
    }  # fmt: skip
    assert arguments("gnm", options) == (("weights", str(weights)), ("radius", 2))
    for bad, message in (
        ("gnm", "PLANNER.OPTION=VALUE"), ("weights=x", "PLANNER.OPTION=VALUE"), ("gnm.weights=none.onnx", "cannot read none.onnx"),
        ("gnm.two words=1", "PLANNER.OPTION=VALUE"),
    ):  # fmt: skip
        with pytest.raises(gloam.UsageError, match=message):
            parse_options([bad])
    with pytest.raises(gloam.UsageError, match="twice"):
        parse_options(["gnm.radius=1", "gnm.radius=2"])


def test_files_are_compared_by_content(tmp_path: Path) -> None:
    for name, content in (("a", b"1"), ("b", b"1"), ("c", b"2")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "net.onnx").write_bytes(content)
    requests = {n: Request(("vint",), options=parse_options([f"vint.weights={tmp_path / n}"])) for n in "abc"}
    out = tmp_path / "out"
    out.mkdir()
    requests["a"].keep(out)
    kept = Request.read(out / "request.json")
    assert kept.options == requests["a"].options and kept.options[0].value.name == str(tmp_path / "a")
    requests["b"].keep(out)
    with pytest.raises(gloam.UsageError, match=r"another benchmark \(vint.weights differ"):
        requests["c"].keep(out)
    with pytest.raises(gloam.UsageError, match=r"another benchmark \(vint.radius differ"):
        replace(requests["a"], options=(*requests["a"].options, Option("vint", "radius", 3))).keep(out)
    with pytest.raises(gloam.UsageError, match=r"another benchmark \(plugins differ"):
        replace(requests["a"], plugins=plugin_files([str(PLUGIN)])).keep(out)
    text = json.loads((out / "request.json").read_text())
    for broken in ([{"planner": "vint"}], 5, [{"planner": "vint", "name": "x", "value": {"name": "y"}}]):
        (out / "request.json").write_text(json.dumps(text | {"options": broken}))
        with pytest.raises(gloam.InputError, match="'options' cannot be read"):
            Request.read(out / "request.json")


def test_wrong_calls_end_before_the_first_episode(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "broken.py").write_text("import gloam\nraise RuntimeError('on Mondays')\n")
    (tmp_path / "bad.onnx").write_bytes(b"no network")
    out = tmp_path / "out"
    for given, message in (
        (["--planners", "nobody"], "there is no planner 'nobody'"),
        (["--planners", "route,../route", "--set", "../route.type=route"], "a planner's name is also a folder's"),
        (["--planners", "gnm"], "planner 'gnm' cannot be created: planner 'gnm' needs weights"),
        (["--planners", "gnm", "--set", f"gnm.weights={tmp_path}/none.onnx"], "cannot read"),
        (["--planners", "gnm", "--set", f"gnm.weights={tmp_path}/bad.onnx"], "planner 'gnm' cannot be created"),
        (["--planners", "route", "--set", "route.speed=2"], "planner 'route' cannot be created: TypeError"),
        (["--planners", "route", "--set", "gnm.radius=2"], "option gnm.radius is for a planner that the benchmark does not have"),
        (["--planners", "route", "--plugin", str(tmp_path / "none.py")], "none.py cannot be imported: there is no such file"),
        (["--planners", "route", "--plugin", str(tmp_path / "broken.py")], "cannot be imported: RuntimeError: on Mondays"),
        (["--planners", "route", "--plugin", "no_such_module"], "No module named 'no_such_module'"),
    ):  # fmt: skip
        assert command(*given, "--out", str(out)) in (1, 2)
        assert message in capsys.readouterr().err
        assert not out.exists()


def test_own_policy_is_a_default_once_it_exists(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Request] = []
    monkeypatch.setattr("gloam.navigation.benchmark.runner.run", lambda request, *_: asked.append(request) or [])
    monkeypatch.setattr("gloam.home", lambda: tmp_path)
    assert command("--no-report", "--out", str(tmp_path / "out")) == 0
    assert "gloam is left out" in capsys.readouterr().err and asked[0].planners == ("straight", "replay", "lidar", "route")
    with pytest.raises(gloam.UsageError, match="'own' has no network yet"):
        completed(("own",), (Option("own", "type", "gloam"),))
    own_weights().parent.mkdir(parents=True)
    own_weights().write_bytes(b"network")
    assert command("--no-report", "--out", str(tmp_path / "out")) == 0
    assert asked[1].planners[-1] == "gloam" and asked[1].options == (Option("gloam", "weights", asked[1].options[0].value),)
    assert "left out" not in capsys.readouterr().err


def test_a_process_that_serves_one_robot_gets_one_episode_at_a_time() -> None:
    assert Workers().single("far") == Workers(1) and Workers(1).single("far") == Workers(1)
    for more in (Workers(2), Workers(1, "auto")):
        with pytest.raises(gloam.UsageError, match="'far' serves one robot at a time"):
            more.single("far")
    assert ExternalPlanner.serves_one and not any(make_planner(name).serves_one for name in ("straight", "lidar"))


def test_planners_of_one_type_have_own_names() -> None:
    load_plugin(str(PLUGIN))
    options = parse_options(["calm.type=brief", "slow.type=brief", "slow.pause=0.5"])
    request = Request(("calm", "slow"), ("house",), ("none",), 1, options=options)
    request.check()
    specs = list(request.specs())
    assert [spec.options for spec in specs] == [(("type", "brief"),), (("type", "brief"), ("pause", 0.5))]
    assert {str(spec.path) for spec in specs} == {"calm/house/none/0000", "slow/house/none/0000"}


def test_cost_by_planner() -> None:
    results = [
        {"planner": planner, "tier": "direct", "wall_seconds": wall, "cpu_seconds": 2 * wall}
        for planner, wall in (("route", 1.0), ("lidar", 100.0), ("route", 3.0))
    ]
    lines = cost_lines(results, 7.4, "a machine")
    assert [line.split() for line in lines[1:3]] == [
        ["route", "direct", "2", "2.0", "4.0"], ["lidar", "direct", "1", "100.0", "200.0"]
    ]
    assert lines[3] == "all 3 episodes: 104 s in their processes, 3 min of CPU time; this call took 7.4 s"
    assert len({len(line) for line in lines[:3]}) == 1


def do(folder: Path, task: int) -> int:
    """Work of a test's process: 3 dies at its first attempt, 4 raises, 5 takes a minute."""
    mark = folder / str(task)
    first = not mark.exists()
    mark.write_text(str(os.getpid()))
    if task == 3 and first:
        os.kill(os.getpid(), signal.SIGKILL)
    if task == 4:
        raise KeyError("four")
    time.sleep(60 if task == 5 else 0)
    return 2 * task


def test_a_death_is_the_failure_of_one_task(tmp_path: Path) -> None:
    tasks = deque([1, 3, 2])
    made: list[tuple[int, int | Died]] = []
    for task, result in local_results(partial(do, tmp_path), tasks, 2):
        made.append((task, result))
        if isinstance(result, Died):
            tasks.append(task)
    assert Counter(made) == Counter([(1, 2), (2, 4), (3, Died()), (3, 6)])
    with pytest.raises(gloam.Error, match="KeyError: 'four'"):
        list(local_results(partial(do, tmp_path), deque([4]), 1))


def test_closing_ends_the_processes(tmp_path: Path) -> None:
    results = local_results(partial(do, tmp_path), deque([1, 5]), 2)
    assert next(results) == (1, 2)
    await_(lambda: (tmp_path / "5").exists() and (tmp_path / "5").read_text() != "")
    begin = time.monotonic()
    results.close()
    assert time.monotonic() - begin < 5
    for task in "15":
        assert not Path("/proc", (tmp_path / task).read_text()).exists()


def await_(condition: Callable[[], object], seconds: float = 120) -> None:
    """Waits until the condition is true. Fails after so many seconds of wall time."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


class _Probe:
    def __init__(self, *values: float) -> None:
        self._values = list(values)

    def open(self) -> _Probe:
        return self

    def __iter__(self) -> Iterator[Any]:
        while self._values:
            yield SimpleNamespace(values=[self._values.pop(0)])


def test_visibility_is_of_the_mean_extinction() -> None:
    meter = VisibilityMeter(SimpleNamespace(sensors={PROBE: _Probe(10.0, 30.0)}))  # type: ignore[arg-type]
    assert meter.mean() is None and meter.least() is None
    meter.sample()
    meter.sample()
    assert meter.mean() == pytest.approx(15.0) and meter.least() == pytest.approx(10.0)


@pytest.mark.parametrize(("weather", "metres"), [({"visibility": 12, "medium": "fog"}, 12.0), ({}, 100_000.0)])
def test_visibility_is_that_of_the_weather(weather: dict[str, Any], metres: float) -> None:
    world = arena(probe=[visibility_probe(f"{ROBOT}/trunk", EYE)], **({"weather": weather} if weather else {})).compile()
    hashes = []
    for measures in (True, False):
        with gloam.Simulation(world, seed=1) as sim:
            meter = VisibilityMeter(sim) if measures else None
            sim.run_until(time=1.6)
            if meter is not None:
                meter.sample()
                assert meter.mean() == pytest.approx(metres, rel=0.01) and meter.least() == pytest.approx(metres, rel=0.01)
            if measures:
                camera = list(world.cameras).index("go/front")
                assert np.allclose(sim.memory.array("cam_pos")[camera], EYE), "the probe is at the camera"
            hashes.append(sim.hash)
    assert hashes[0] == hashes[1], "measuring changes nothing"


class Bench:
    """`gloam bench nav` in processes of their own, of which the environment has a mark."""

    def __init__(self, folder: Path) -> None:
        self.marks = folder / "marks"
        self.marks.touch()

    def start(self, out: Path, count: int = 5) -> subprocess.Popen[str]:
        arguments = ["--planners", "brief", "--plugin", str(PLUGIN), "--set", "brief.pause=0.2", "--scenes", "house"]
        arguments += ["--levels", "none", "--n", str(count), "--workers", "2", "--no-report", "--out", str(out)]
        environment = {**os.environ, "GLOAM_TEST_MARKS": str(self.marks)}
        return subprocess.Popen(
            [sys.executable, str(COMMANDS), "bench", *arguments], env=environment, stderr=subprocess.PIPE, text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )  # fmt: skip

    def processes(self) -> list[int]:
        """All processes with the mark that have not ended."""
        return [int(p.name) for p in Path("/proc").iterdir() if p.name.isdigit() and self._is_ours(p)]

    def _is_ours(self, process: Path) -> bool:
        try:
            return f"GLOAM_TEST_MARKS={self.marks}".encode() in (process / "environ").read_bytes()
        except OSError:
            return False

    def begun(self) -> list[tuple[int, int]]:
        """(seed, process) of each episode that has begun."""
        return [(int(seed), int(pid)) for seed, pid in (line.split() for line in self.marks.read_text().splitlines())]

    def kill_all(self) -> None:
        for pid in self.processes():
            os.kill(pid, signal.SIGKILL)


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    made = Bench(tmp_path)
    yield made
    made.kill_all()


def files(out: Path) -> dict[str, Path]:
    """Finished episodes by number."""
    return {file.parent.name: file for file in out.glob("episodes/brief/house/none/*/episode.json") if file.parent.name[0] != "."}


def hashes(out: Path) -> dict[str, str]:
    return {name: json.loads(file.read_text())["hash"] for name, file in files(out).items()}


@pytest.mark.slow
def test_kills_lose_nothing(bench: Bench, tmp_path: Path) -> None:
    """The command is killed, and then a process of the call that continues: each episode is complete once, and equal to
    that of an undisturbed run."""
    out = tmp_path / "killed"
    first = bench.start(out)
    await_(lambda: len(files(out)) >= 1 and len(bench.begun()) > len(files(out)))
    first.send_signal(signal.SIGKILL)
    first.wait()
    await_(lambda: not bench.processes(), 15)
    kept = {name: file.stat().st_mtime_ns for name, file in files(out).items()}
    assert 1 <= len(kept) < 5
    (out / "maps/house/.0000.part").mkdir(parents=True)
    second = bench.start(out)
    count = len(bench.begun())
    await_(lambda: len(bench.begun()) > count)
    os.kill(bench.begun()[-1][1], signal.SIGKILL)
    told = second.communicate(timeout=200)[1]
    assert second.returncode == 0 and "it runs again" in told, told
    assert sorted(files(out)) == [f"{k:04}" for k in range(5)]
    assert {name: files(out)[name].stat().st_mtime_ns for name in kept} == kept, "finished episodes are not run again"
    begun = Counter(seed for seed, _ in bench.begun())
    assert all(begun[EpisodeSpec("brief", "house", "none", int(name)).pair_seed] == 1 for name in kept)
    assert not [p for p in out.rglob(".*") if p.name != ".lock"], "no unfinished folder is left"
    results = [json.loads(file.read_text()) for file in files(out).values()]
    assert {result["outcome"] for result in results} == {"lost"}
    third = bench.start(tmp_path / "calm")
    assert third.wait(200) == 0
    assert hashes(tmp_path / "calm") == hashes(out) and len(set(hashes(out).values())) == 5


@pytest.mark.slow
def test_ctrl_c_ends_quickly_and_tells_how_to_continue(bench: Bench, tmp_path: Path) -> None:
    process = bench.start(tmp_path / "out", 50)
    await_(lambda: len(files(tmp_path / "out")) >= 1 and len(bench.begun()) > len(files(tmp_path / "out")))
    for pid in bench.processes():  # as a terminal does
        os.kill(pid, signal.SIGINT)
    begin = time.monotonic()
    told = process.communicate(timeout=30)[1]
    assert time.monotonic() - begin < 6 and process.returncode == 130
    assert f"{len(files(tmp_path / 'out'))} episodes are complete in" in told and "the same command continues" in told
    assert "Traceback" not in told
    await_(lambda: not bench.processes(), 5)
    assert not [p for p in (tmp_path / "out").rglob(".*") if p.name != ".lock"]
