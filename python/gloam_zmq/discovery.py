"""Servers of the same user on this machine, by the private files that they write."""
import json
import os
import stat
from pathlib import Path


def machine_id():
    """Equal for two processes of one user on one running machine: "boot id:user id"."""
    try:
        boot = Path("/proc/sys/kernel/random/boot_id").read_text().strip()
    except OSError:
        return ""
    return f"{boot}:{os.geteuid()}"


def _folder():
    runtime = os.environ.get("XDG_RUNTIME_DIR", "")
    return Path(runtime) / "gloam" if runtime.startswith("/") else Path(f"/tmp/gloam-{os.geteuid()}")


def _is_private(path, mode):
    about = path.lstat()
    return about.st_uid == os.geteuid() and stat.S_IMODE(about.st_mode) & mode == 0


def _is_alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True


def servers():
    """Servers that run, newest first: [{address, streams, token, public_key, scene, machine, pid}]."""
    folder = _folder()
    try:
        if not _is_private(folder, 0o077):
            return []
        files = sorted(folder.glob("zmq-*.json"), key=lambda file: file.stat().st_mtime, reverse=True)
    except OSError:
        return []
    found = []
    for file in files:
        try:
            if _is_private(file, 0o077):
                found.append(json.loads(file.read_text()))
        except (OSError, ValueError):
            continue
    return [server for server in found if server.get("machine") == machine_id() and _is_alive(int(server.get("pid", 0)))]
