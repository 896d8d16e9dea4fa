"""Planners in other processes: their faults are counted and never end a simulation; replies may contain anything."""

from __future__ import annotations

import json
import math
import re
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import gloam
import numpy as np
import pytest
from gloam.navigation import Arrived, Driver, Observation, Rig, Task, Velocity, Waypoints, make_planner
from gloam.navigation.planners import messages
from gloam.navigation.scene import drive, planner_of
from hypothesis import given
from hypothesis import strategies as st
from navigation_scene import arena

pytest.importorskip("zmq")
from gloam.navigation.planners.external import ExternalPlanner, serve  # noqa: E402
from navigation_peer import Peer, Reply  # noqa: E402

GOAL = (0.2, -0.4)


@pytest.fixture(scope="module")
def world() -> gloam.World:
    return arena().compile()


@pytest.fixture
def sim(world: gloam.World) -> Iterator[gloam.Simulation]:
    with gloam.Simulation(world) as made:
        yield made


@pytest.fixture
def address(tmp_path: Path) -> str:
    return f"ipc://{tmp_path}/planner"


def as_json(value: object) -> Reply:
    return [json.dumps(value).encode()]


# Parsing of replies.

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(st.sampled_from(["velocity", "waypoints", "chosen", "arrived", "x"]), inner),
    max_leaves=20,
)
NEARLY = st.fixed_dictionaries(
    {},
    optional={
        "velocity": st.lists(st.floats() | st.integers() | st.booleans(), max_size=4) | JSON,
        "waypoints": st.lists(st.lists(st.floats(-9, 9) | st.integers(), max_size=4), max_size=4) | JSON,
        "chosen": st.integers(-2, 4) | JSON,
        "arrived": st.booleans() | JSON,
    },
)


def is_sound(answer: object) -> bool:
    if isinstance(answer, Velocity):
        return all(type(v) is float and math.isfinite(v) for v in (answer.vx, answer.vy, answer.yaw_rate))
    if isinstance(answer, Waypoints):
        points = answer.points
        return bool(points.shape[1] in (2, 4) and np.isfinite(points).all() and 0 <= answer.chosen < len(points))
    return isinstance(answer, Arrived)


@given(st.binary(max_size=200) | JSON.map(lambda value: json.dumps(value).encode()))
def test_any_bytes_are_a_reply_or_an_error(data: bytes) -> None:
    try:
        reply = messages.parsed_reply(data)
    except ValueError:
        return
    assert isinstance(reply, dict)


@given(JSON | NEARLY)
def test_any_json_is_an_answer_or_an_error(value: object) -> None:
    if not isinstance(value, dict):
        return
    for parse in (messages.answer_of, messages.description_of):
        try:
            result = parse(value)
        except ValueError:
            continue
        assert isinstance(result, messages.Description) or is_sound(result)


@given(
    st.builds(Velocity, *[st.floats(allow_nan=False, allow_infinity=False)] * 3)
    | st.just(Arrived())
    | st.builds(lambda rows: Waypoints(np.array(rows), 0), st.lists(st.tuples(st.floats(-9, 9), st.floats(-9, 9)), min_size=1, max_size=9))
)
def test_answers_survive_the_way_through_json(answer: Velocity | Waypoints | Arrived) -> None:
    back = messages.answer_of(messages.parsed_reply(json.dumps(messages.encoded(answer)).encode()))
    if isinstance(answer, Waypoints):
        assert isinstance(back, Waypoints) and np.array_equal(answer.points, back.points) and answer.chosen == back.chosen
    else:
        assert back == answer


@pytest.mark.parametrize(
    "reply",
    [
        {},
        {"velocity": "123"},
        {"velocity": [0.1, 0.2]},
        {"velocity": [0.1, 0.2, True]},
        {"velocity": ["0.1", "0", "0"]},
        {"velocity": [10**400, 0, 0]},
        {"velocity": [0, 0, 0], "arrived": True},
        {"waypoints": []},
        {"waypoints": [["a", "b"]]},
        {"waypoints": [[1, 2], [1, 2, 0, 1]]},
        {"waypoints": [[1, 2]], "chosen": 1},
        {"waypoints": [[1, 2]], "chosen": 0.0},
        {"waypoints": [[0, 0]] * 2000},
        {"arrived": 1},
    ],
)
def test_wrong_answers_are_rejected(reply: dict[str, object]) -> None:
    with pytest.raises(ValueError, match="must|one of"):
        messages.answer_of(reply)


def test_replies_of_hostile_size_and_depth_are_rejected() -> None:
    with pytest.raises(ValueError, match="at most"):
        messages.parsed_reply(b" " * (messages.LONGEST_REPLY + 1))
    with pytest.raises(ValueError, match="not JSON"):
        messages.parsed_reply(b"[" * 500_000)
    with pytest.raises(ValueError, match="NaN is not a finite number"):
        messages.parsed_reply(b'{"velocity": [NaN, 0, 0]}')


def test_fewer_waypoints_than_the_usual_choice_are_an_answer() -> None:
    answer = messages.answer_of({"waypoints": [[1, 0], [2, 0]]})
    assert isinstance(answer, Waypoints) and answer.chosen == 1


# Another process, or a thread in its place.


def test_a_planner_in_another_process_declares_its_needs_and_repeats(world: gloam.World, address: str) -> None:
    alive = threading.Event()
    alive.set()
    thread = threading.Thread(target=serve, args=(make_planner("lidar"), address, alive.is_set), daemon=True)
    thread.start()
    hashes = set()
    for _ in range(2):
        with gloam.Simulation(world) as sim:
            planner = ExternalPlanner(address)
            assert planner.needs == {"scan"} and planner.rate == make_planner("lidar").rate
            driver = Driver(sim, Rig("go", lidar="lidar"), planner)
            driver.run(Task("go", goal=GOAL, radius=0.4), 12.0, lambda s: driver.has_arrived)  # noqa: B023
            assert driver.has_arrived and driver.stats.invalid == 0
            hashes.add(sim.hash)
            with pytest.raises(gloam.UsageError, match=r"rejects the task: a planner with A\* needs"):
                planner.reset(Task("go"))
            driver.close()
    alive.clear()
    thread.join()
    assert len(hashes) == 1


FAULTS: list[tuple[Reply, str]] = [
    ([b"\xff\xfe"], "not JSON"),
    ([b"velocity"], "not JSON"),
    ([b""], "not JSON"),
    (as_json([0.1, 0, 0]), "must be a JSON object"),
    (as_json({"velocity": [math.nan, 0, 0]}), "not a finite number"),
    (as_json({"waypoints": [["left", "right"]]}), "must be a number, got a text"),
    (as_json({"error": "no \x1b[31mpath"}), "no \\\\x1b\\[31mpath"),
    ([b"{}", b"{}"], "must have one part"),
]


@pytest.mark.parametrize("fault, message", FAULTS)
def test_faults_of_replies_are_counted_and_the_next_answer_applies(
    sim: gloam.Simulation, address: str, fault: Reply, message: str
) -> None:
    with Peer(address, lambda k: fault if k < 3 else as_json({"velocity": [0.2, 0, 0]})):
        driver = Driver(sim, Rig("go"), ExternalPlanner(address))
        driver.run(Task("go"), 1.2)
        driver.close()
    assert (driver.stats.plans, driver.stats.invalid) == (5, 3)
    assert re.search(message, driver.stats.error), driver.stats.error
    assert sim.robots["go"].velocity[0] != 0


def test_silence_and_messages_that_are_too_long_are_given_up(sim: gloam.Simulation, address: str) -> None:
    long = [b" " * (messages.LONGEST_REPLY + 1)]
    with Peer(address, lambda k: [None, long, as_json({"velocity": [0.2, 0, 0]}), None][min(k, 3)]) as peer:
        driver = Driver(sim, Rig("go"), ExternalPlanner(address, timeout=0.3))
        driver.run(Task("go"), 3.0)
        driver.close()
    # After three silences in sequence the planner is not called any more.
    assert peer.plans == 6
    assert (driver.stats.plans, driver.stats.invalid) == (12, 11)
    assert "has not answered within 0.3 s" in driver.stats.error
    assert sim.time == pytest.approx(3.0)


def test_a_slow_answer_is_late_and_applies_as_declared(sim: gloam.Simulation, address: str) -> None:
    def plan(k: int) -> Reply:
        threading.Event().wait(0.1 if k == 1 else 0)
        return as_json({"velocity": [0.2, 0, 0]})

    with Peer(address, plan, {"needs": [], "latency": 0.05}):
        driver = Driver(sim, Rig("go"), ExternalPlanner(address))
        sent: list[float] = []
        robot = driver._robot
        send = robot.command
        robot.command = lambda **v: (sent.append(round(sim.time, 3)), send(**v))[1]  # type: ignore[method-assign]
        driver.run(Task("go"), 0.7)
        driver.close()
    assert (driver.stats.plans, driver.stats.late, driver.stats.invalid) == (3, 1, 0)
    assert sent[:3] == [0.05, 0.3, 0.55]


def test_descriptions_and_tasks_that_are_rejected(address: str) -> None:
    for describe, match in [
        ({"rate": 0}, "rate must be above 0"),
        ({"needs": ["smell"]}, "'needs' must be"),
        ({"image_size": [0, 5]}, "'image_size' must be"),
        ({"error": "no weights"}, "no weights"),
        (7, "must be a JSON object"),
    ]:
        with Peer(address, as_json, describe), pytest.raises(gloam.IoError, match=match):
            ExternalPlanner(address)
    with Peer(address, as_json, reset={"error": "too far"}):
        planner = ExternalPlanner(address)
        with pytest.raises(gloam.UsageError, match="rejects the task: too far"):
            planner.reset(Task("go"))
        planner.close()


def test_addresses_and_programs_that_are_wrong(address: str) -> None:
    with pytest.raises(gloam.IoError, match="has not answered"):
        ExternalPlanner(address, timeout=0.2)
    with pytest.raises(gloam.UsageError, match="must begin with"):
        ExternalPlanner("http://127.0.0.1")
    with pytest.raises(gloam.UsageError, match="cannot connect"):
        ExternalPlanner("tcp://127.0.0.1:no")
    with pytest.raises(gloam.UsageError, match="cannot be started"):
        ExternalPlanner(address, command="no-such-program --x")
    with pytest.raises(gloam.UsageError, match="cannot be started"):
        ExternalPlanner(address, command="'unclosed")
    with pytest.raises(gloam.IoError, match="ended with exit code 3"):
        ExternalPlanner(address, command=f"{sys.executable} -c 'raise SystemExit(3)'")


PROGRAM = """
import json, os, sys, zmq
socket = zmq.Context().socket(zmq.REP)
socket.bind(sys.argv[1])
for k in range(100):
    call = json.loads(socket.recv_multipart()[0])["call"]
    if k == 5:
        os._exit(9)
    socket.send_json({"describe": {"needs": []}, "reset": {}, "plan": {"velocity": [0.2, 0, 0]}}[call])
"""


def test_a_process_that_crashes_is_reported_and_the_robot_stops(tmp_path: Path, address: str) -> None:
    (tmp_path / "planner.py").write_text(PROGRAM)
    command = f"{sys.executable} {tmp_path}/planner.py {address}"
    scene = arena(planner={"type": "external", "command": command, "address": address})
    with gloam.Simulation(scene.compile()) as sim:
        driver = drive(sim, 4.0, allow_programs=True)
        assert driver.stats.plans == 16 and driver.stats.invalid == 13
        assert "the planner's process ended with exit code 9" in driver.stats.error
        assert math.hypot(*sim.robots["go"].velocity[:2]) < 0.1


@pytest.mark.parametrize(
    "planner, deed",
    [
        ({"command": "touch {folder}/made", "address": "ipc:///tmp/x"}, "starts the program"),
        ({"address": "tcp://192.0.2.1:7801"}, "connects to tcp://192.0.2.1:7801"),
        ({"address": "tcp://localhost.example.org:7801"}, "connects to"),
    ],
)
def test_scenes_start_programs_only_with_permission(tmp_path: Path, planner: dict[str, str], deed: str) -> None:
    table = {"type": "external"} | {key: text.format(folder=tmp_path) for key, text in planner.items()}
    scene = arena(planner=table)
    with gloam.Simulation(scene.compile()) as sim:
        with pytest.raises(gloam.UsageError, match=deed) as caught:
            drive(sim, 1.0)
    assert "--allow-programs" in caught.value.hint
    assert not (tmp_path / "made").exists()


def test_a_scene_may_name_a_planner_that_runs_on_this_machine(address: str) -> None:
    with Peer(address, as_json):
        planner_of(arena(planner={"type": "external", "address": address})).close()


def test_serve_answers_malformed_requests_and_faults(address: str) -> None:
    import zmq

    class Broken(type(make_planner("straight"))):  # type: ignore[misc]
        def plan(self, observation: Observation) -> Velocity:
            raise RuntimeError("lost")

    alive = threading.Event()
    alive.set()
    thread = threading.Thread(target=serve, args=(Broken(), address, alive.is_set), daemon=True)
    thread.start()
    context = zmq.Context()
    with context.socket(zmq.REQ) as socket:
        socket.connect(address)
        for request, expected in [
            ([b"{"], "JSONDecodeError"),
            ([b"7"], "TypeError"),
            ([b'{"call": "plan"}'], "KeyError"),
            (messages.plan_request(Observation(0, (0, 0, 0), (0, 0, 0)), frozenset()), "RuntimeError: lost"),
        ]:
            socket.send_multipart(request)
            assert socket.poll(5000)
            assert expected in socket.recv_json()["error"]
    context.term()
    alive.clear()
    thread.join()
