"""SLAM methods: each one is a program that reads a sequence and writes poses, in a process of its own (docs/slam.md)."""

from __future__ import annotations

import os
import re
import shutil
import sys
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import gloam
from gloam.experiments.request import is_folder_name

_ADAPTERS = Path(__file__).with_name("adapters")
SENSORS = ("mono", "stereo", "rgbd", "mono_imu", "stereo_imu", "rgbd_imu", "lidar")
_KEYS = {"name", "sensors", "command", "environment"}


@dataclass(frozen=True)
class Method:
    """name: also of folders; sensors: that it reads, see SENSORS; command: words in which {sequence}, {out}, {truth}, {seed},
    {vocabulary}, {python} and {home} are replaced; environment: of `gloam slam install`, whose Python is {python}, "" = this
    one; home: environment variable with the folder of the user's installation, "" = none."""

    name: str
    sensors: str
    command: tuple[str, ...]
    environment: str = ""
    home: str = ""

    @property
    def is_metric(self) -> bool:
        """Whether its sensors measure lengths."""
        return self.sensors != "mono"

    @property
    def has_lidar(self) -> bool:
        """Whether it estimates poses of the LiDAR."""
        return self.sensors == "lidar"

    def words(self, values: Mapping[str, str]) -> list[str]:
        """The command with its values. Errors: UsageError if its environment or program is missing."""
        python = sys.executable if not self.environment else str(python_of(self.environment))
        home = os.environ.get(self.home, "") if self.home else ""
        if self.home and not Path(home or "/nowhere").is_dir():
            problem = f"method '{self.name}' cannot start: {self.home} is not the folder of its installation"
            raise gloam.UsageError(problem, hint=f"set {self.home}")
        answer = [_filled(word, {**values, "python": python, "home": home}) for word in self.command]
        if shutil.which(answer[0]) is None:
            hint = f"./gloam slam install {self.environment}" if self.environment else "give its full path"
            raise gloam.UsageError(f"method '{self.name}' cannot start: there is no program '{answer[0]}'", hint=hint)
        return answer


def _adapter(name: str, sensors: str, script: str, environment: str, *more: str) -> Method:
    return Method(name, sensors, ("{python}", str(_ADAPTERS / script), "{sequence}", "{out}", *more), environment)


def _odometry(sensors: str) -> Method:
    return _adapter(f"odometry_{sensors}", sensors, "odometry.py", "opencv", "--sensors", sensors)


def _orb_slam3(sensors: str) -> Method:
    return _adapter(f"orb_slam3_{sensors}", sensors, "orb_slam3.py", "orb_slam3", "--sensors", sensors, "--vocabulary", "{vocabulary}")


def _installed(program: str, name: str, *more: str) -> Method:
    made = _adapter(name, "mono", "installed.py", "", "--method", program, "--home", "{home}", *more)
    return replace(made, home=f"{program.upper()}_HOME")


METHODS: dict[str, Method] = {
    method.name: method
    for method in (
        _adapter("noisy_truth", "mono", "noisy_truth.py", "", "--truth", "{truth}", "--seed", "{seed}"),
        *(_odometry(sensors) for sensors in ("mono", "stereo", "rgbd")),
        *(_orb_slam3(sensors) for sensors in SENSORS if sensors != "lidar"),
        _installed("orb_slam2", "orb_slam2_mono", "--vocabulary", "{vocabulary}"),
        _installed("mast3r_slam", "mast3r_slam"),
        _adapter("kiss_icp", "lidar", "kiss.py", "kiss_icp"),
    )
}


def _filled(word: str, values: Mapping[str, str]) -> str:
    def value(match: re.Match[str]) -> str:
        if match[1] not in values:
            raise gloam.UsageError(f"the command of a method has no value for '{{{match[1]}}}'; there are: {', '.join(sorted(values))}")
        return values[match[1]]

    return re.sub(r"\{(\w+)\}", value, word)


def python_of(environment: str) -> Path:
    """The Python of an environment that `gloam slam install` has made. GLOAM_SLAM_ENVIRONMENTS names another folder of them."""
    folder = os.environ.get("GLOAM_SLAM_ENVIRONMENTS") or gloam.home() / ".venv"
    return Path(folder) / f"slam-{environment}" / "bin" / "python"


def opencv_python() -> Path:
    """The Python of an environment that has OpenCV. Errors: UsageError if none is installed."""
    for name in ("orb_slam3", "opencv"):
        if (python := python_of(name)).is_file():
            return python
    raise gloam.UsageError("a vocabulary needs OpenCV", hint="./gloam slam install opencv")


def load_method(name: str) -> Method:
    """A known method by its name, or one of a TOML file with name, sensors, command and environment.

    Errors: NotFoundError for an unknown name; InputError for a malformed file.
    """
    if name in METHODS:
        return METHODS[name]
    file = Path(name)
    if file.suffix != ".toml":
        raise gloam.NotFoundError(f"there is no method '{name}'; there are: {', '.join(METHODS)}", hint="name a TOML file for another one")
    try:
        table: dict[str, Any] = tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise gloam.IoError(f"cannot read the method: {error.strerror}", str(file)) from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise gloam.InputError(f"the method is not valid TOML: {error}", str(file)) from None
    return _checked(table, file)


def _checked(table: Mapping[str, Any], file: Path) -> Method:
    if unknown := set(table) - _KEYS:
        raise gloam.InputError(f"unknown key '{sorted(unknown)[0]}'; there are: {', '.join(sorted(_KEYS))}", str(file))
    name, sensors, command = table.get("name", file.stem), table.get("sensors"), table.get("command")
    if not is_folder_name(name):
        raise gloam.InputError(f"the name of a method is also a folder's, which {name!r} cannot be", str(file))
    if sensors not in SENSORS:
        raise gloam.InputError(f"sensors must be one of {', '.join(SENSORS)}, got {sensors!r}", str(file))
    if not isinstance(command, list) or not command or not all(isinstance(word, str) for word in command):
        raise gloam.InputError("command must be a list of words, the program first", str(file))
    # Programs beside the file are named relative to it.
    first = command[0] if "/" not in command[0] or os.path.isabs(command[0]) else str((file.parent / command[0]).resolve())
    environment = table.get("environment", "")
    if not isinstance(environment, str):
        raise gloam.InputError("environment must be a name", str(file))
    return replace(Method(name, sensors, (first, *command[1:])), environment=environment)
