"""Real rclpy for tests: wheels of a list with hashes in a virtual environment, and the message packages that they lack, generated.

    python3 tests/e2e/ros2_env.py

makes it in the folder of the tests' data (about two minutes, once) and prints the interpreter that has it all.
"""
import fcntl
import hashlib
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import fetch_data  # noqa: E402
from e2e import ros2_interfaces  # noqa: E402

HERE = Path(__file__).resolve().parent
REQUIREMENTS = HERE / "ros2_requirements.txt"
PYTHON = "python3.11"  # the wheels are built for it
# Folders of the machine that built the wheels, in their CMake files.
BUILT_WITH = {"/opt/python/cp311-cp311/include/python3.11": "import sysconfig; print(sysconfig.get_paths()['include'])",
              "/opt/python/cp311-cp311/lib/python3.11/site-packages/numpy/_core/include": "import numpy; print(numpy.get_include())"}


class RosEnv:
    """An interpreter with rclpy and its environment variables."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.venv, self.overlay = self.folder / "venv", self.folder / "overlay"
        self.python = self.venv / "bin" / "python"

    def variables(self, domain=0):
        packages = self.overlay / "lib" / "python3.11" / "site-packages"
        return {**os.environ, "AMENT_PREFIX_PATH": f"{self.overlay}:{self.venv}", "CMAKE_PREFIX_PATH": f"{self.overlay}:{self.venv}",
                "LD_LIBRARY_PATH": f"{self.overlay / 'lib'}:{self.venv / 'lib'}", "PYTHONPATH": str(packages),
                "PATH": f"{self.venv / 'bin'}:{os.environ['PATH']}", "ROS_DOMAIN_ID": str(domain), "PYTHONUNBUFFERED": "1",
                "ROS_LOG_DIR": str(self.folder / "log")}


def check(command, **options):
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    if result.returncode != 0:
        raise RuntimeError(f"{command[0]}: " + "\n".join(result.stdout.splitlines()[-8:]))
    return result.stdout.strip()


def install_wheels(env):
    shutil.rmtree(env.venv, ignore_errors=True)
    check([PYTHON, "-m", "venv", env.venv])
    check([env.python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--require-hashes", "-r", REQUIREMENTS])
    here = {there: check([env.python, "-c", question]) for there, question in BUILT_WITH.items()}
    for path in env.venv.rglob("*.cmake"):
        text = path.read_text(errors="surrogateescape")
        changed = text
        for there, folder in here.items():
            changed = changed.replace(there, folder)
        if changed != text:
            path.write_text(changed, errors="surrogateescape")


def write_package(folder, name, interfaces, dependencies):
    for path, text in interfaces.items():
        kind = path.split("/")[0]
        file = folder / f"{path}.{kind}"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text + "\n")
    depends = "".join(f"<depend>{d}</depend>" for d in dependencies)
    (folder / "package.xml").write_text(
        f'<?xml version="1.0"?>\n<package format="3"><name>{name}</name><version>0.0.0</version><description>for tests</description>'
        '<maintainer email="nobody@example.com">nobody</maintainer><license>Apache-2.0</license>'
        "<buildtool_depend>ament_cmake</buildtool_depend><buildtool_depend>rosidl_default_generators</buildtool_depend>"
        f"{depends}<member_of_group>rosidl_interface_packages</member_of_group>"
        "<export><build_type>ament_cmake</build_type></export></package>\n")
    files = " ".join(f'"{path}.{path.split("/")[0]}"' for path in interfaces)
    finds = "".join(f"find_package({d} REQUIRED)\n" for d in dependencies)
    (folder / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.20)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n"
        f"find_package(rosidl_default_generators REQUIRED)\n{finds}"
        f"rosidl_generate_interfaces({name} {files} DEPENDENCIES {' '.join(dependencies)})\nament_package()\n")


def generate(env):
    shutil.rmtree(env.overlay, ignore_errors=True)
    for name, (interfaces, dependencies) in ros2_interfaces.PACKAGES.items():
        source, build = env.folder / "source" / name, env.folder / "build" / name
        shutil.rmtree(source, ignore_errors=True)
        shutil.rmtree(build, ignore_errors=True)
        write_package(source, name, interfaces, dependencies)
        check(["cmake", "-S", source, "-B", build, "-G", "Ninja", f"-DCMAKE_INSTALL_PREFIX={env.overlay}", "-DBUILD_TESTING=OFF",
               "-DCMAKE_BUILD_TYPE=MinSizeRel", f"-DPython3_EXECUTABLE={env.python}"], env=env.variables())
        check(["ninja", "-C", build, "install"], env=env.variables())
        shutil.rmtree(build)


def ros2_env():
    """The environment, made where it is not there. SkipTest where it cannot be: no Python 3.11, no network."""
    if shutil.which(PYTHON) is None:
        raise unittest.SkipTest(f"rclpy's wheels need {PYTHON}")
    wanted = hashlib.sha256(REQUIREMENTS.read_bytes() + (HERE / "ros2_interfaces.py").read_bytes()).hexdigest()[:8]
    env = RosEnv(fetch_data.default_folder() / f"ros2-{wanted}")
    env.folder.mkdir(parents=True, exist_ok=True)
    with open(env.folder / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (env.folder / "done").exists():
            try:
                install_wheels(env)
                generate(env)
            except RuntimeError as error:
                raise unittest.SkipTest(f"no rclpy: {error}") from error
            (env.folder / "done").touch()
    return env


if __name__ == "__main__":
    print(ros2_env().python)
