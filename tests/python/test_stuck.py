"""Callbacks and hooks that never return: closing waits for a time, then says which one, and the interpreter still ends."""
from __future__ import annotations

from pathlib import Path
from typing import Any

from scenes import BALL

LOAD = """
import threading, time, signal, os
import gloam
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell in the background ignores it
sim = gloam.load("ball.xml")
never = threading.Event()
def closed(close):
    start = time.monotonic()
    try:
        close()
        print("no error")
    except gloam.StuckError as error:
        print(3 < time.monotonic() - start < 9, error)  # 5 s from the start of the call
"""


def model(folder: Path) -> None:
    (folder / "ball.xml").write_text(BALL)


def test_a_stuck_callback_does_not_keep_close_or_the_interpreter(tmp_path: Path, run_python: Any) -> None:
    model(tmp_path)
    told = run_python(LOAD + """
sim.sensors["where"].open(required=False, callback=lambda sample: never.wait())
sim.step(20)
time.sleep(0.2)
closed(sim.close)
print(repr(sim))
other = gloam.load("ball.xml")
other.sensors["where"].open(required=False, callback=lambda sample: never.wait())
other.run(pace="fast")
time.sleep(0.2)
""", timeout=30)
    assert told.stdout.startswith("True the callback of sensor 'where' has not returned"), told.stdout
    assert "closed" in told.stdout and "sensor 'where'" in told.stderr


def test_a_stuck_stream_can_be_closed_by_itself(tmp_path: Path, run_python: Any) -> None:
    model(tmp_path)
    told = run_python(LOAD + """
where = sim.sensors["where"].open(required=False, callback=lambda sample: never.wait())
sim.step(20)
time.sleep(0.2)
closed(where.close)
sim.step(20)
never.set()
time.sleep(0.5)
sim.close()
print(sim)
""", timeout=30)
    assert told.stdout.startswith("True the callback of sensor 'where'"), told.stdout


def test_a_stuck_hook_does_not_keep_close_or_the_interpreter(tmp_path: Path, run_python: Any) -> None:
    model(tmp_path)
    told = run_python(LOAD + """
sim.on_step(lambda memory: never.wait())
sim.run(pace="fast")
time.sleep(0.2)
closed(sim.close)
""", timeout=30)
    assert told.stdout.startswith("True a step hook has not returned"), told.stdout


def test_ctrl_c_ends_a_step_that_waits_for_a_stuck_callback(tmp_path: Path, run_python: Any) -> None:
    model(tmp_path)
    told = run_python(LOAD + """
sim.sensors["where"].open(callback=lambda sample: never.wait())
threading.Timer(1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
start = time.monotonic()
try:
    sim.step(20000)
except KeyboardInterrupt:
    print(time.monotonic() - start < 3)
closed(sim.close)
""", timeout=30)
    assert told.stdout.startswith("True\nTrue the callback"), told.stdout


def test_a_callback_that_is_only_slow_is_waited_for(tmp_path: Path, run_python: Any) -> None:
    model(tmp_path)
    told = run_python(LOAD + """
ended = []
sim.sensors["where"].open(callback=lambda sample: (time.sleep(1), ended.append(sample.step)))
sim.step()
closed(sim.close)
print(len(ended))
""", timeout=30)
    assert told.stdout.split()[:2] == ["no", "error"] and int(told.stdout.split()[2]) >= 1, told.stdout
