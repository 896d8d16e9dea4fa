"""The memory tests of `import gloam` against a module and library built with the address sanitizer.

    ./gloam python tests/python/asan.py [ARGUMENTS OF PYTEST]

builds gloam_python of the preset asan and runs FILES, or what ARGUMENTS name. Python itself is not instrumented: the
sanitizer is loaded before all else, takes over malloc, and sees what instrumented code and memcpy read.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import env

ROOT = Path(__file__).resolve().parents[2]
BUILT = ROOT / "build" / "asan" / "python" / "gloam"
FILES = ["tests/python/test_lifetime.py", "tests/python/test_dlpack.py", "tests/python/test_misuse.py"]


def runtime() -> str:
    """Libraries to load first: the sanitizer's, and that of C++, which it must find at once to take over exceptions."""
    names = ("libclang_rt.asan-x86_64.so", "libstdc++.so.6")
    return " ".join(
        subprocess.run(
            ["clang-19", f"-print-file-name={name}"], capture_output=True, text=True, check=True
        ).stdout.strip()
        for name in names
    )


def variables() -> dict[str, str]:
    """Environment of a Python whose gloam is sanitized.

    Freed memory is filled, so that also NumPy's own loops read other values.
    """
    return {
        "LD_PRELOAD": runtime(),
        "PYTHONMALLOC": "malloc",
        "ASAN_OPTIONS": "detect_leaks=0:abort_on_error=0:allocator_may_return_null=1"
        ":max_free_fill_size=1073741824:free_fill_byte=251",
        "UBSAN_OPTIONS": "print_stacktrace=1",
        "GLOAM_BUILT": str(BUILT),
        "GLOAM_ASAN": "1",
    }


def main() -> int:
    made = subprocess.run([ROOT / "gloam", "setup", "gloam_python"], env={**os.environ, "GLOAM_PRESET": "asan"})
    if made.returncode != 0:
        return made.returncode
    command = [str(env.python_env()), "-m", "pytest", "-q", *(sys.argv[1:] or FILES)]
    return subprocess.run(command, cwd=ROOT, env={**env.variables(), **variables()}).returncode


if __name__ == "__main__":
    sys.exit(main())
