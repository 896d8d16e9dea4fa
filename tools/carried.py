"""Puts the libraries that a wheel's tree needs into it (tools/wheel.py): copies with names of their own, licences, the C library asked for."""
import hashlib
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pack

ROOT = Path(__file__).resolve().parent.parent
# Libraries that every Linux of the tag has (PEP 600): the C library's parts, and GCC's, of which a process must have one alone.
OF_THE_SYSTEM = re.compile(r"^(linux-vdso|ld-linux|lib(c|m|dl|rt|pthread|resolv|util|stdc\+\+|gcc_s)\.so)")
OURS = {"bin/gloam": "$ORIGIN/../lib/gloam", "lib/libgloam.so.0.1": "$ORIGIN/gloam"}


def tell(command):
    return subprocess.run([str(part) for part in command], check=True, text=True, stdout=subprocess.PIPE).stdout


def programs(folder):
    """All programs and libraries in a folder."""
    for path in sorted(folder.rglob("*")):
        if path.is_file() and not path.is_symlink():
            with open(path, "rb") as stream:
                if stream.read(4) == b"\x7fELF":
                    yield path


def needed(file):
    """Name and file of every library that a file needs, those of the system and of its own tree apart."""
    for line in tell(["ldd", file]).splitlines():
        name, _, rest = line.strip().partition(" => ")
        name = name.split()[0] if name else ""
        if not name or OF_THE_SYSTEM.match(Path(name).name) or name == "statically":
            continue
        found = rest.split(" (")[0]
        if not found or "not found" in found:
            sys.exit(f"gloam: error: {file.name} needs {name}, which is not on this machine")
        yield name, Path(found)


def own_name(name, file):
    """libtbb.so.12 -> libtbb-1a2b3c4d.so.12, by what is in it."""
    stem, dot, version = name.partition(".so")
    return f"{stem}-{hashlib.sha256(file.read_bytes()).hexdigest()[:8]}{dot}{version}"


def package_of(file):
    """Debian's package of a file, "" where none owns it."""
    for path in (file, file.resolve(), Path("/usr") / str(file.resolve()).lstrip("/")):
        told = subprocess.run(["dpkg", "-S", path], text=True, capture_output=True)
        if told.returncode == 0:
            return told.stdout.split(":")[0]
    return ""


def copy_licences(files, folder):
    """Texts of Debian's packages and of the wheels that are carried."""
    for package in sorted({package_of(file) for file in files}):
        text = Path("/usr/share/doc") / package / "copyright"
        if not package or not text.exists():
            sys.exit("gloam: error: a library is carried whose licence is not on this machine")
        (folder / package).mkdir(parents=True, exist_ok=True)
        shutil.copy(text, folder / package)
    for info in sorted((ROOT / ".venv" / "wheels").glob("*.dist-info")):
        for text in [path for path in info.rglob("*") if re.match(r"(LICEN|NOTICE|COPYING|third)", path.name, re.I) and path.is_file()]:
            target = folder / info.name.split("-")[0] / text.relative_to(info)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(text, target)


def glibc_of(files):
    """The newest version of the C library that any file asks for, as (major, minor)."""
    asked = [re.findall(r"Name: GLIBC_(\d+)\.(\d+)", tell(["readelf", "-VW", file])) for file in files]
    return max(tuple(map(int, version)) for versions in asked for version in versions)


def slim(package):
    """Without symbols that nobody looks up, and without networks that Gloam never asks for."""
    core = next(package.glob("lib/gloam/oidn/lib/libOpenImageDenoise_core.so.*"), None)
    if core is not None:
        pack.without_other_networks(core)
        (core.parent / "libtbb.so.12").unlink(missing_ok=True)  # the one of libgloam.so does
    for file in [package / "bin" / "gloam", package / "lib" / "libgloam.so.0.1", *package.glob("_core.*.so")]:
        tell(["strip", "--strip-unneeded", file])


def carry(tree, patchelf):
    """Fills the unpacked wheel. Returns the least version of the C library that it needs."""
    package = tree / "gloam"
    private = package / "lib" / "gloam"
    slim(package)
    own = list(programs(package))
    outside = {name: file for part in own for name, file in needed(part) if not file.resolve().is_relative_to(package.resolve())}
    renamed = {name: own_name(name, file) for name, file in outside.items()}
    for name, file in outside.items():
        shutil.copy(file, private / renamed[name])
    for file in [*own, *(private / name for name in renamed.values())]:
        options = []
        for name in tell([patchelf, "--print-needed", file]).split():
            if name in renamed:
                options += ["--replace-needed", name, renamed[name]]
        if file.name in renamed.values():
            options += ["--set-soname", file.name, "--set-rpath", "$ORIGIN"]
        elif file.parent == package:
            options += ["--set-rpath", "$ORIGIN/lib:$ORIGIN/lib/gloam"]
        elif str(file.relative_to(package)) in OURS:
            options += ["--set-rpath", OURS[str(file.relative_to(package))]]
        elif options:  # a part of Open Image Denoise
            options += ["--set-rpath", "$ORIGIN:$ORIGIN/../.."]
        if options:
            tell([patchelf, *options, file])
    copy_licences(outside.values(), next(tree.glob("*.dist-info")) / "licenses")
    return glibc_of(programs(package))
