"""What goes wrong in users' programs: exceptions, never a crash or a dead wait."""
from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import gloam
import numpy as np
import pytest
from scenes import ball_file, ball_scene


def test_options_that_there_are_not_raise(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        for call in (lambda: sim.cameras["small"].open(sp=1), lambda: sim.cameras["small"].render(tierr="direct"),
                     lambda: sim.record(tmp_path / "a.mcap", durabel=True).__enter__(), lambda: gloam.run(sim.world, tmp_path / "out", widht=3)):
            with pytest.raises((gloam.UsageError, TypeError), match="did you mean|unexpected"):
                call()


@pytest.mark.parametrize(
    "option, message",
    [
        ({"tier": "raster"}, "there is no render tier 'raster'.*one of: path, interactive, direct"),
        ({"tier": "pth"}, "there is no render tier 'pth'.*did you mean 'path'"),
        ({"device": "gpu"}, "there is no render device 'gpu'"),
        ({"look": "studoi"}, "there is no look 'studoi'.*did you mean 'studio'"),
    ],
)
def test_unknown_words_of_render_options_are_errors(tmp_path: Path, option: dict[str, str], message: str) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        small = sim.cameras["small"]
        for call in (lambda: small.open(**option), lambda: small.render(**option), lambda: sim.view(**option).__enter__()):
            with pytest.raises(gloam.UsageError, match=message):
                call()
        assert small.render(("depth",), tier=None, device="cpu", look="model", spp=1).depth.shape


def test_use_after_close(tmp_path: Path) -> None:
    sim = gloam.load(ball_scene(tmp_path))
    camera = sim.cameras["small"].open(("depth",), tier="direct", spp=1)
    camera.next()
    robot = sim.robots["go"]
    sim.close()
    sim.close()
    for call in (sim.step, camera.next, lambda: sim.time, sim.reset, lambda: robot.command(vx=1), lambda: sim.checkpoint(),
                 lambda: sim.set("sim.duration", 2), sim.pause, sim.run, lambda: sim.subscribe(["/tf"])):
        with pytest.raises(gloam.Error):
            call()
    assert "closed" in repr(sim)


def test_wrong_types_raise(tmp_path: Path) -> None:
    sim = gloam.load(ball_file(tmp_path))
    for call in (lambda: sim.step(None), lambda: sim.step("x"), lambda: sim.step(-1), lambda: sim.run_until(), lambda: sim.run_until(float("nan")),
                 lambda: sim.step_until(None), lambda: sim.step_until(sim.cameras["front"]), lambda: sim.bodies["ball"].push(force=(1, 2)), lambda: sim.bodies["ball"].push(force="up"),
                 lambda: sim.joints["elbow"].set(qpos=[1, 2, 3]), lambda: sim.actuators.__getitem__(3), lambda: sim.set(None, 1),
                 lambda: gloam.load(None), lambda: gloam.load(3), lambda: gloam.load(ball_file(tmp_path), seed=-1),
                 lambda: gloam.load(ball_file(tmp_path), seed="7"), lambda: gloam.load(ball_file(tmp_path), pace="slow"),
                 lambda: gloam.load(ball_file(tmp_path), timestep=-1.0), lambda: setattr(sim.actuators["motor"], "control", None),
                 lambda: sim.restore(None), lambda: sim.recompile(None), lambda: sim.bodies["ball"].set_mocap(((0, 0, 0), (0, 0, 0, 0)))):
        with pytest.raises((gloam.Error, TypeError, ValueError)):
            call()
    sim.step()


def test_a_forked_process_is_told(tmp_path: Path) -> None:
    sim = gloam.load(ball_file(tmp_path))
    sim.step()
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            sim.step()
            os.write(write, b"stepped")
        except gloam.ForkedError:
            os.write(write, b"told")
        finally:
            os._exit(0)
    os.close(write)
    told = os.read(read, 100)
    os.waitpid(child, 0)
    assert told == b"told"
    sim.step()


def test_several_threads_share_a_simulation(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        errors: list[BaseException] = []

        def work(job: int) -> None:
            try:
                for i in range(40):
                    if job == 0:
                        sim.step(3)
                    elif job == 1:
                        _ = sim.robots["go"].pose, sim.time
                    elif job == 2:
                        sim.bodies["go/ball"].push(force=(i, 0, 0))
                    else:
                        sim.cameras["small"].render(("depth",), tier="direct", spp=1)
            except BaseException as error:  # noqa: BLE001
                errors.append(error)

        threads = [threading.Thread(target=work, args=(job,)) for job in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(60)
        assert not any(t.is_alive() for t in threads), "no dead wait"
        assert not errors


def test_threads_that_step_take_turns(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as alone:
        alone.step(600)
        wanted = alone.hash
    with gloam.load(ball_file(tmp_path)) as sim:
        qpos = sim.memory.array("qpos")

        def step() -> None:
            for _ in range(100):
                sim.step(2)

        threads = [threading.Thread(target=step) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(60)
        assert sim.step_count == 600 and sim.hash == wanted and np.isfinite(qpos).all()


def test_a_callback_that_steps_is_told(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        where = sim.sensors["where"].open(callback=lambda sample: sim.step())
        with pytest.raises(gloam.UsageError, match="callback"):
            for _ in range(50):
                sim.step(2)
        where.close()
        sim.on_step(lambda memory: sim.reset())
        with pytest.raises(gloam.UsageError, match="callback"):
            sim.step()


def test_a_thread_that_closes_ends_a_long_run(tmp_path: Path) -> None:
    sim = gloam.load(ball_file(tmp_path))
    closer = threading.Timer(0.2, sim.close)
    closer.start()
    with pytest.raises(gloam.Error):
        sim.run_until(1e6)
    closer.join(20)
    assert not closer.is_alive()


def test_other_threads_run_while_it_steps(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        count = 0
        done = threading.Event()

        def look() -> None:
            nonlocal count
            while not done.is_set():
                count += 1
                time.sleep(0.001)

        thread = threading.Thread(target=look)
        thread.start()
        start = time.monotonic()
        while time.monotonic() - start < 0.4:
            sim.step(2000)
        done.set()
        thread.join()
        assert count > 20


def test_questions_while_it_runs_with_a_hook(tmp_path: Path) -> None:
    code = f"""
import gloam
sim = gloam.load({str(ball_file(tmp_path))!r})
sim.on_step(lambda memory: memory.time)
sim.run("fast")
last = 0
while last < 2000:
    last = sim.step_count
    sim.time, sim.hash, sim.stats, sim.bodies["ball"].pose
sim.pause()
print("ended")
"""
    told = subprocess.run([sys.executable, "-c", code], timeout=180, capture_output=True, text=True, check=True).stdout
    assert told == "ended\n"


def test_ctrl_c_stops_a_long_run(tmp_path: Path) -> None:
    code = f"""
import gloam, signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job has it ignored
sim = gloam.load({str(ball_file(tmp_path))!r})
print("runs", flush=True)
try:
    sim.run_until(1e6)
except KeyboardInterrupt:
    at = sim.step_count
    sim.step()
    print("stopped", sim.step_count - at, flush=True)
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None and program.stdout.readline() == "runs\n"
        time.sleep(0.3)
        program.send_signal(signal.SIGINT)
        try:
            told, _ = program.communicate(timeout=120)
        finally:
            program.kill()
        assert (told, program.returncode) == ("stopped 1\n", 0)


def test_a_program_that_closes_nothing_ends(tmp_path: Path) -> None:
    code = f"""
import gloam
sim = gloam.load({str(ball_file(tmp_path))!r})
cam = sim.cameras["front"].open(("rgb",), width=32, height=24, tier="direct", spp=1, callback=lambda frame: None)
sim.run("fast")
"""
    assert subprocess.run([sys.executable, "-c", code], timeout=180, check=False).returncode == 0


def test_the_collector_may_run_in_a_callback(tmp_path: Path) -> None:
    code = f"""
import gc, time, weakref
import gloam
gc.disable()
def start():
    sim = gloam.load({str(ball_file(tmp_path))!r})
    sim.sensors["where"].open(callback=lambda sample: sim)
    sim.step(5)
    return weakref.ref(sim)
gone = start()
assert gone() is not None
other = gloam.load({str(ball_file(tmp_path))!r})
where = other.sensors["where"].open(callback=lambda sample: gc.collect())
other.step(5)
where.flush()
print("freed" if gone() is None else "kept")
sim = gloam.load({str(ball_file(tmp_path))!r})
sim.step(10)
"""
    told = subprocess.run([sys.executable, "-c", code], timeout=180, capture_output=True, text=True, check=False)
    assert (told.returncode, told.stdout) == (0, "freed\n"), told.stderr


def test_errors_can_be_sent_between_processes() -> None:
    error = gloam.InputError("wrong", "a.toml", 3, 4, "mend it")
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) == "a.toml:3:4: wrong (mend it)" and again.line == 3
