"""`gloam bench slam`: methods on the same motion under several conditions.

A tour of each scene is recorded once and replayed under each level; all methods read the same sequences. Every part is a folder
that gets its name when it is complete: a repeated call continues after any interruption.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable, Collection, Iterable
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

import gloam
from gloam._distribute.manifest import write_json
from gloam.experiments.checks import Fields, read_object
from gloam.experiments.files import locked, remove_parts, whole
from gloam.experiments.request import REQUEST_FILE, STAMP, check_known, check_once, keep_request
from gloam.experiments.words import Remaining
from gloam.navigation.benchmark.floor_plan import plan_file
from gloam.navigation.benchmark.options import file_of
from gloam.navigation.benchmark.places import ALL_LEVELS, LEVELS, PLACES

from .estimate import read_tum
from .methods import Method, load_method, opencv_python
from .recorded import examine, scene_name
from .results import OUTCOME, Key, case_of
from .run import run_method
from .sequence import TRUTH, Condition, make_sequence
from .tour import TOUR_SENSORS, Sensors, Tour, record_tour

VOCABULARY, OVERLAYS = "vocabulary.txt", "overlays"
_PARTS = ("tours", "cases/*", "runs/*/*/*")  # parents of folders that appear when they are complete
_MAY_DIFFER = STAMP | {"methods", "runs", "log"}  # between the calls that continue a benchmark
Tell = Callable[[str], None]


@dataclass(frozen=True)
class Request:
    """Runs of a results folder: all methods x scenes x levels x numbers 0 … runs - 1.

    methods: names, or TOML files; levels: of adversity, or scene files that are applied instead; legs, duration [s] (None = all):
    of the tours; tier, width, height, rate: of the images; limit: time that a run may take, per second of its sequence;
    vocabulary: file for ORB-SLAM, "" = made from the images in clear air; log, log_hash: file with the run that is the only scene's
    tour, "" = tours are recorded, and its content (of_log); camera: of its robot, "" = the first one; machine, version, started:
    text for the page.
    """

    methods: tuple[str, ...]
    scenes: tuple[str, ...] = ("house", "warehouse")
    levels: tuple[str, ...] = LEVELS
    runs: int = 10
    seed: int = 1
    legs: int = 3
    duration: float | None = None
    tier: str = "interactive"
    width: int = 640
    height: int = 480
    rate: float = 20.0
    limit: float = 20.0
    vocabulary: str = ""
    log: str = ""
    log_hash: str = ""
    camera: str = ""
    machine: str = ""
    version: str = ""
    started: str = ""

    def check(self) -> None:
        """Errors: NotFoundError for an unknown scene or level; UsageError for names twice and numbers out of range."""
        if not self.log:
            check_known("scene", self.scenes, PLACES)
        check_known("level", [level for level in self.levels if not level.endswith(".toml")], ALL_LEVELS)
        for kind, asked in (("method", self.methods), ("scene", self.scenes), ("level", self.level_names)):
            check_once(kind, asked)
        if not 1 <= self.runs <= 10_000 or not 0 <= self.seed < 2**32 or not 1 <= self.legs <= 20:
            raise gloam.UsageError("expected 1 to 10000 runs, 1 to 20 legs, and a seed from 0 to 2^32 - 1")
        if not (16 <= self.width <= 4096 and 16 <= self.height <= 4096 and 0.1 <= self.rate <= 1000 and 0 < self.limit <= 1e6):
            raise gloam.UsageError("expected images of 16 to 4096 pixels, a rate of 0.1 to 1000 Hz and a limit above 0")

    def of_log(self, log: Path, camera: str) -> Request:
        """The same with the run of a log as its tour. Errors: gloam.UsageError if the file cannot be read."""
        file = file_of(log)
        return replace(self, scenes=(scene_name(log),), log=file.name, log_hash=file.sha256[:16], camera=camera)

    @property
    def level_names(self) -> tuple[str, ...]:
        """Names of the levels; a scene file's is its own without the suffix."""
        return tuple(Path(level).stem if level.endswith(".toml") else level for level in self.levels)

    def _keep_overlays(self, out: Path) -> None:
        """Copies scene files into the folder, so that it holds all its input. Errors: UsageError if one has changed."""
        for level, name in zip(self.levels, self.level_names, strict=True):
            if level == name:
                continue
            try:
                text = Path(level).read_bytes()
            except OSError as error:
                raise gloam.IoError(f"cannot read the scene file: {error.strerror}", level) from error
            kept = out / OVERLAYS / f"{name}.toml"
            if kept.is_file() and kept.read_bytes() != text:
                raise gloam.UsageError(f"{level} has changed since {out} was begun", hint="choose another folder")
            kept.parent.mkdir(exist_ok=True)
            kept.write_bytes(text)

    def keep(self, out: Path) -> None:
        """Writes request.json, or continues the benchmark that the folder holds. Errors: UsageError if that is another one;
        InputError if its file is damaged."""
        self._keep_overlays(out)
        file = out / REQUEST_FILE
        mine: dict[str, Any] = json.loads(json.dumps({**asdict(self), "levels": self.level_names}))
        known = read_object(file) if file.is_file() else mine
        kept = Fields(known, file)
        # Folders of earlier versions lack fields whose values were the defaults.
        before = {field.name: known.get(field.name, field.default) for field in fields(self) if field.name not in _MAY_DIFFER}
        different = [f"{name} {value} and {mine[name]}" for name, value in before.items() if value != mine[name]]
        mine |= {"methods": list(dict.fromkeys([*kept.value("methods"), *self.methods])), "runs": max(self.runs, kept.integer("runs"))}
        keep_request(out, mine, different, kept.text("started"))


def run(request: Request, out: Path, workers: int = 1, tell: Tell | None = None) -> list[dict[str, Any]]:
    """Makes the missing parts of a folder. Returns all outcomes, each with its key.

    workers: methods that run at the same time; more than one disturbs times per frame. Errors: as Request.check and
    load_method; UsageError if a method cannot start or the folder is in use; gloam.Error, OSError if files cannot be written.
    """
    request.check()
    say = tell or (lambda _: None)
    methods = {method.name: method for method in map(load_method, request.methods)}
    if len(methods) != len(request.methods):
        raise gloam.UsageError("two methods have one name")
    for method in methods.values():  # before hours of rendering
        method.words({"sequence": "", "out": "", "truth": "", "seed": "", "vocabulary": ""})
    with locked(out):
        remove_parts(out, *_PARTS)
        request.keep(out)
        _make_cases(request, methods.values(), out, say)
        vocabulary = _vocabulary(request, methods, out, say)
        keys = [Key(m, s, v, n) for n in range(request.runs) for s in request.scenes for v in request.level_names for m in methods]
        missing = [key for key in keys if not _file(out, key).is_file()]
        remaining = Remaining(len(missing))
        with ThreadPoolExecutor(workers) as pool:
            futures = {pool.submit(_run, methods[key.method], key, request, vocabulary, out): key for key in missing}
            try:
                for done, future in enumerate(as_completed(futures), 1):
                    state = future.result()
                    say(f"{done} of {len(missing)} runs: {futures[future].path} {state}{remaining.after(done)}")
            except BaseException:
                pool.shutdown(wait=True, cancel_futures=True)
                raise
    return [{**asdict(key), **json.loads(_file(out, key).read_text(encoding="utf-8"))} for key in keys]


def _file(out: Path, key: Key) -> Path:
    return out / "runs" / key.path / OUTCOME


_SENSOR_NAMES = {"stereo": "a stereo pair", "lidar": "a LiDAR", "imu": "a calibrated IMU"}
_SENSOR_FILES = {"stereo": "right.txt", "lidar": "scans.txt"}  # of sequences that have these sensors


def _tour(request: Request, scene: str, out: Path, say: Tell) -> tuple[Path, Sensors]:
    """The log of a scene's tour, which is recorded if it is missing, and the sensors of its robot."""
    tour = out / "tours" / scene
    if not tour.is_dir():
        say(f"examining {request.log}" if request.log else f"recording a tour of {scene}")
        with whole(tour) as part:
            if request.log:
                sensors, length = examine(Path(request.log), request.camera, plan_file(out, scene, "none"))
            else:
                sensors, length = TOUR_SENSORS, record_tour(Tour(scene, request.seed, request.legs), part / "tour.mcap")
            write_json(part / "tour.json", {"length": length, "sensors": asdict(sensors)})
    kept = read_object(tour / "tour.json")
    return Path(request.log) if request.log else tour / "tour.mcap", Sensors(**kept.get("sensors", asdict(TOUR_SENSORS)))


def _check_sensors(methods: Iterable[Method], sensors: Sensors) -> None:
    """Errors: gloam.UsageError for a method that needs a sensor which the robot lacks."""
    has = {"stereo": sensors.right, "lidar": sensors.lidar, "imu": sensors.imu}
    for method in methods:
        for kind in set(method.sensors.split("_")) & set(has):
            if not has[kind]:
                raise gloam.UsageError(f"method '{method.name}' needs {_SENSOR_NAMES[kind]}, which the log does not have")


def _make_cases(request: Request, methods: Collection[Method], out: Path, say: Tell) -> None:
    """Tours and sequences that are missing, or that lack a sensor: images are expensive, so only methods that read the right
    camera or the LiDAR get them. A sequence that is made again has the same images."""
    needed = {"exists"} | (set(_SENSOR_FILES) & {method.sensors.removesuffix("_imu") for method in methods})
    missing = [(s, v) for s in request.scenes for v in request.level_names if not needed <= _sensors_of(case_of(out, s, v))]
    remaining = Remaining(len(missing))
    for done, (scene, level) in enumerate(missing):
        log, sensors = _tour(request, scene, out, say)
        _check_sensors(methods, sensors)
        say(f"sequence {done + 1} of {len(missing)}: {scene}, {level}{remaining.after(done)}")
        case = case_of(out, scene, level)
        has = {kind: kind in needed | _sensors_of(case) for kind in _SENSOR_FILES}
        overlay = out / OVERLAYS / f"{level}.toml"
        condition = Condition(
            level, overlay if overlay.is_file() else None, request.tier, request.width, request.height, request.rate,
            request.duration, has["stereo"], has["lidar"],
        )  # fmt: skip
        with whole(case) as part:
            make_sequence(log, condition, part, sensors)
            shutil.rmtree(case, ignore_errors=True)


def _sensors_of(case: Path) -> set[str]:
    """The sensors of a sequence beside its left camera, and "exists"; empty if there is no sequence."""
    if not case.is_dir():
        return set()
    return {"exists"} | {kind for kind, file in _SENSOR_FILES.items() if (case / "sequence" / file).is_file()}


def _vocabulary(request: Request, methods: dict[str, Method], out: Path, say: Tell) -> str:
    """The file for {vocabulary}; "" if no method has it."""
    users = [method for method in methods.values() if any("{vocabulary}" in word for word in method.command)]
    if not users or request.vocabulary:
        return request.vocabulary and str(Path(request.vocabulary).resolve())
    file = out / VOCABULARY
    if not file.is_file():
        say("making the vocabulary of ORB features")
        part = file.with_name(f".{VOCABULARY}")
        script = Path(__file__).with_name("adapters") / "vocabulary.py"
        images = [str(case_of(out, scene, request.level_names[0]) / "sequence" / "rgb") for scene in request.scenes]
        done = subprocess.run([str(opencv_python()), str(script), str(part), *images], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise gloam.Error(f"the vocabulary cannot be made: {(done.stderr.strip().splitlines() or ['no output'])[-1]}")
        part.replace(file)
    return str(file.resolve())


def _run(method: Method, key: Key, request: Request, vocabulary: str, out: Path) -> str:
    case = case_of(out, key.scene, key.level).resolve()
    limit = 60.0 + request.limit * float(np.ptp(read_tum(case / TRUTH).times))
    with whole((out / "runs" / key.path).resolve()) as part:
        values = {"seed": str(request.seed * 1000 + key.number), "vocabulary": vocabulary}
        outcome = run_method(method, case, part, values, limit)
        write_json(part / OUTCOME, outcome.as_dict())
    return outcome.state
