"""Puts the libraries that a wheel's tree needs into it, with their licences (tools/wheel.py)."""

import hashlib
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pack

ROOT = Path(__file__).resolve().parent.parent
# Libraries that every Linux of the tag has (PEP 600): those of C, and those of GCC, of which a process has one.
OF_THE_SYSTEM = re.compile(r"^(linux-vdso|ld-linux|lib(c|m|dl|rt|pthread|resolv|util|stdc\+\+|gcc_s)\.so)")
# Where our own files look for libraries.
OURS = {
    "bin/gloam": "$ORIGIN/../lib/gloam",
    "lib/libgloam.so.*": "$ORIGIN/gloam",
    "_core.*.so": "$ORIGIN/lib:$ORIGIN/lib/gloam",
}


def tell(command):
    return subprocess.run([str(part) for part in command], check=True, text=True, stdout=subprocess.PIPE).stdout


def programs(folder):
    """All programs and libraries in a folder."""
    for path in sorted(folder.rglob("*")):
        if path.is_file() and not path.is_symlink():
            with open(path, "rb") as stream:
                if stream.read(4) == b"\x7fELF":
                    yield path


def needed(file, here):
    """Name and file of every library that a file needs, but for those of the system and those named in `here`."""
    for line in tell(["ldd", file]).splitlines():
        name, _, rest = line.strip().partition(" => ")
        name = name.split()[0] if name else ""
        if not name or OF_THE_SYSTEM.match(Path(name).name) or name in here or name == "statically":
            continue
        found = rest.split(" (")[0]
        if not found or "not found" in found:
            sys.exit(f"gloam: error: {file.name} needs {name}, which was not found on this machine")
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
            sys.exit("gloam: error: the licence of a bundled library was not found on this machine")
        (folder / package).mkdir(parents=True, exist_ok=True)
        shutil.copy(text, folder / package)
    for info in sorted((ROOT / ".venv" / "wheels").glob("*.dist-info")):
        for text in [
            path
            for path in info.rglob("*")
            if re.match(r"(LICEN|NOTICE|COPYING|third)", path.name, re.I) and path.is_file()
        ]:
            target = folder / info.name.split("-")[0] / text.relative_to(info)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(text, target)


def glibc_of(files):
    """The newest version of the C library that any file asks for, as (major, minor)."""
    asked = [re.findall(r"Name: GLIBC_(\d+)\.(\d+)", tell(["readelf", "-VW", file])) for file in files]
    return max(tuple(map(int, version)) for versions in asked for version in versions)


def slim(package, patchelf):
    """Without symbols that nobody looks up, and without networks that Gloam never asks for."""
    core = next(package.glob("lib/gloam/oidn/lib/libOpenImageDenoise_core.so.*"), None)
    if core is not None:
        pack.without_other_networks(core)
        (core.parent / "libtbb.so.12").unlink(missing_ok=True)  # the one of libgloam.so does
    for pattern, folders in OURS.items():
        for file in package.glob(pattern):
            tell(["strip", "--strip-unneeded", file])
            tell([patchelf, "--set-rpath", folders, file])


def copy_libraries(package, own):
    """Copies what is needed and not in the package. Returns the new name of each, and the files that were copied."""
    folder, names, files = package / "lib" / "gloam", {}, []
    here = {file.name for file in own}
    for part in own:
        for name, file in needed(part, here):
            if name not in names:
                names[name] = own_name(name, file)
                shutil.copy(file, folder / names[name])
                files.append(file)
    return names, files


def carry(tree, patchelf):
    """Fills the unpacked wheel. Returns the least version of the C library that it needs."""
    package = tree / "gloam"
    slim(package, patchelf)
    own = list(programs(package))
    names, files = copy_libraries(package, own)
    carried = [package / "lib" / "gloam" / name for name in names.values()]
    for file in [*own, *carried]:
        options = []
        for name in set(tell([patchelf, "--print-needed", file]).split()) & set(names):
            options += ["--replace-needed", name, names[name]]
        if file in carried:
            options += ["--set-soname", file.name, "--set-rpath", "$ORIGIN"]
        elif options:
            folders = tell([patchelf, "--print-rpath", file]).strip().split(":")
            folders.append(f"$ORIGIN/{os.path.relpath(package / 'lib' / 'gloam', file.parent)}")
            options += ["--set-rpath", ":".join(filter(None, dict.fromkeys(folders)))]
        if options:
            tell([patchelf, *options, file])
    copy_licences(files, next(tree.glob("*.dist-info")) / "licenses")
    return glibc_of(programs(package))
