"""Arrays and objects outlive what they came from, and say so where they cannot.

Also run under the address sanitizer (asan.py): bytes of an array are copied by memcpy, which it watches in NumPy, too.
"""

from __future__ import annotations

import gc
import os
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scenes import ball_file, ball_scene

import gloam

FAST = {"tier": "direct", "spp": 1, "denoise": False}


def look_at(kept: dict[str, tuple[Any, bytes]]) -> None:
    """Reads every array and compares it with what it was."""
    gc.collect()
    for name, (array, was) in kept.items():
        assert array.tobytes() == was, name


def keep(**arrays: Any) -> dict[str, tuple[Any, bytes]]:
    return {name: (array, array.tobytes()) for name, array in arrays.items()}


def use_memory(folder: Path) -> None:
    """Makes and drops another simulation, whose memory may lie where the first one's lay."""
    with gloam.load(ball_scene(folder)) as sim:
        sim.cameras["small"].render(**FAST)
        sim.step(10)
    gc.collect()


def test_frames_outlive_their_stream(tmp_path: Path) -> None:
    sim = gloam.load(ball_scene(tmp_path))
    camera = sim.cameras["small"].open(("rgb", "depth", "segmentation"), **FAST)
    frames = [sim.step_until(camera) for _ in range(4)]
    kept = {
        f"{i} {name}": value
        for i, frame in enumerate(frames)
        for name, value in keep(rgb=frame.rgb, depth=frame.depth, ids=frame.ids, K=frame.K).items()
    }
    camera.close()
    del frames, camera
    look_at(kept)
    sim.close()
    del sim
    use_memory(tmp_path)
    look_at(kept)


def test_scans_outlive_their_simulation(tmp_path: Path) -> None:
    sim = gloam.load(Path(gloam.home()) / "examples" / "lidar.toml")
    lidar = sim.lidars[next(iter(sim.lidars))].open()
    scan = lidar.next()
    kept = keep(points=scan.points, intensity=scan.intensity, ring=scan.ring, range=scan.range)
    sim.close()
    del scan, lidar, sim
    use_memory(tmp_path)
    look_at(kept)


def after(sim: Any, what: str) -> None:
    {
        "close": sim.close,
        "reset": sim.reset,
        "recompile": lambda: sim.recompile(sim.scene),
        "set": lambda: sim.set("light.sun.illuminance", 100.0),
        "restore": lambda: sim.restore(sim.checkpoint()),
    }[what]()


@pytest.mark.parametrize("what", ["close", "reset", "recompile", "set", "restore"])
def test_live_arrays_stay_readable(tmp_path: Path, what: str) -> None:
    sim = gloam.load(ball_scene(tmp_path))
    sim.step(10)
    arrays = [sim.memory.array(name) for name in ("qpos", "qvel", "ctrl", "xpos", "body_mass", "geom_rgba")]
    arrays += [sim.robots["go"].qpos, sim.joints["go/elbow"].qvel]
    after(sim, what)
    for array in arrays:
        assert np.isfinite(np.frombuffer(array.tobytes(), array.dtype)).all()
    if what != "close":
        sim.step(10)
        assert sim.joints["go/elbow"].qpos.shape == (1,)
    del sim
    use_memory(tmp_path)
    for array in arrays:
        assert np.isfinite(np.frombuffer(array.tobytes(), array.dtype)).all()


def test_new_arrays_are_the_new_state(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        old = sim.memory.array("qpos")
        sim.set("light.sun.illuminance", 100.0)
        sim.step(50)
        new = sim.memory.array("qpos")
        assert new[2] < 1.0 and sim.joints["go/free"].qpos[2] == new[2]
        assert old.shape == new.shape


def test_a_name_that_a_recompile_takes_away_raises(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        elbow = sim.joints["go/elbow"]
        text = (tmp_path / "ball.xml").read_text()
        (tmp_path / "ball.xml").write_text(text.replace('"elbow"', '"wrist"'))
        sim.recompile(sim.scene)
        with pytest.raises(gloam.NotFoundError):
            elbow.qpos[:] = 0
        assert sim.joints["go/wrist"].qpos.shape == (1,)


def test_checkpoints_outlive_their_simulation(tmp_path: Path) -> None:
    first = gloam.load(ball_scene(tmp_path))
    first.step(20)
    instant = first.checkpoint()
    first.step(20)
    end = first.hash
    first.close()
    del first
    gc.collect()
    with gloam.load(ball_scene(tmp_path)) as second:
        second.restore(instant)
        assert second.hash == instant.hash
        second.step(20)
        assert second.hash == end


def test_elements_alone_keep_what_they_need(tmp_path: Path) -> None:
    joint = gloam.load(ball_file(tmp_path)).joints["elbow"]
    gc.collect()
    qpos = joint.qpos
    del joint
    use_memory(tmp_path)
    assert qpos.tobytes() == np.zeros(1).tobytes()


def test_messages_outlive_their_subscription(tmp_path: Path) -> None:
    sim = gloam.load(ball_scene(tmp_path))
    subscription = sim.subscribe(["/clock", "/tf*"])
    sim.step(20)
    messages = list(subscription)
    assert messages
    data, decoded = [bytes(m.data) for m in messages], [str(m.decode()) for m in messages]
    subscription.close()
    sim.close()
    del subscription, sim
    use_memory(tmp_path)
    assert [bytes(m.data) for m in messages] == data and [str(m.decode()) for m in messages] == decoded


def test_callbacks_keep_their_frames(tmp_path: Path) -> None:
    frames: list[Any] = []
    sim = gloam.load(ball_scene(tmp_path))
    sim.cameras["small"].open(("depth",), callback=frames.append, **FAST)
    sim.run_until(0.1)
    sim.close()
    del sim
    gc.collect()
    assert frames
    kept = {str(i): (frame.depth, frame.depth.tobytes()) for i, frame in enumerate(frames)}
    frames.clear()
    use_memory(tmp_path)
    look_at(kept)


def test_arrays_are_read_while_another_thread_closes(tmp_path: Path) -> None:
    sim = gloam.load(ball_scene(tmp_path))
    arrays = [sim.memory.array("qpos"), sim.cameras["small"].render(("depth",), **FAST).depth]
    reading, done = threading.Event(), threading.Event()

    def read() -> None:
        while not done.is_set():
            for array in arrays:
                array.tobytes()
            reading.set()

    thread = threading.Thread(target=read)
    thread.start()
    assert reading.wait(10)
    sim.close()
    del sim
    use_memory(tmp_path)
    done.set()
    thread.join()


def test_mujocos_objects_outlive_the_simulation(tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    sim = gloam.load(ball_file(tmp_path))
    model, data = sim.model, sim.data
    sim.step(10)
    was = data.qpos.tobytes()
    sim.close()
    del sim
    use_memory(tmp_path)
    assert data.qpos.tobytes() == was and model.body_mass.tobytes() and model.nq == len(data.qpos)


def test_a_log_that_could_not_be_written_outlives_its_simulation(pendulum: Path, run_python: Any) -> None:
    code = f"""
import resource
import gloam
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, resource.RLIM_INFINITY))  # a full disk
for k in range(3):
    try:
        with gloam.load({str(pendulum)!r}) as sim, sim.record(f"{{k}}.mcap", ["/clock", "/tf*"]):
            sim.run_until(time=20)
    except gloam.Error as error:
        kept = error  # with the frames that hold the log
    else:
        raise SystemExit("the log is complete")
"""
    run_python(code, MALLOC_PERTURB_="165")  # freed memory has other values


@pytest.mark.skipif(os.environ.get("GLOAM_ASAN") != "1", reason="shows that asan.py sees a use after free")
@pytest.mark.parametrize("use", ["a.tobytes()", "ctypes.memset(at, 0, 8)"])
def test_the_sanitizer_sees_a_use_after_free(run_python: Any, use: str) -> None:
    code = f"""
import ctypes
import numpy as np
free, malloc = ctypes.CDLL(None).free, ctypes.CDLL(None).malloc
malloc.restype, free.argtypes = ctypes.c_void_p, [ctypes.c_void_p]
at = malloc(64)
a = np.ctypeslib.as_array((ctypes.c_double * 8).from_address(at))
free(at)
{use}
"""
    assert "heap-use-after-free" in run_python(code, expect=1).stderr


@pytest.mark.skipif(os.environ.get("GLOAM_ASAN") == "1", reason="the sanitizer keeps freed memory")
def test_close_frees_the_renderer(examples: Path) -> None:
    """Without the garbage collector: a loop over seeds must not keep the renderers of closed simulations."""
    world = gloam.Scene(examples / "tasks" / "pick.toml").compile()
    sizes = []
    gc.disable()
    try:
        for seed in range(5):
            with gloam.Simulation(world, seed=seed) as sim:
                sim.cameras["above"].render(("depth",), width=64, height=48)
            sizes.append(int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20)
    finally:
        gc.enable()
    assert sizes[-1] - sizes[1] < 150, f"{sizes} MiB"  # with their renderers it grows by 130 MiB each
