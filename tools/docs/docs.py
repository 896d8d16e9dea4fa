#!/usr/bin/env python3
"""Builds the documentation site from README.md, docs/, python/gloam and include/gloam.

  ./gloam docs            into build/site; a broken link is an error
  ./gloam docs --serve    and serves it on this machine until Ctrl-C

The pages are the Markdown files of the repository, arranged as docs/README.md lists them. The Python reference comes from
docstrings and the C++ reference from comments in the public headers; neither needs the compiled program.
"""
import argparse
import functools
import hashlib
import http.server
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ENVIRONMENT = ROOT / ".venv" / "docs"
PYTHON = ENVIRONMENT / "bin" / "python"
REQUIREMENTS = HERE / "requirements.txt"


def say(text):
    print(f"gloam: {text}", file=sys.stderr, flush=True)


def install():
    """Installs the pinned packages into .venv/docs, unless this Python has installed the same list there before."""
    stamp, version = ENVIRONMENT / ".stamp", hashlib.sha256(REQUIREMENTS.read_bytes() + sys.version.encode()).hexdigest()
    if stamp.exists() and stamp.read_text() == version:
        return
    say("installing the pinned packages of the documentation site (about 30 MB)")
    shutil.rmtree(ENVIRONMENT, ignore_errors=True)
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", ENVIRONMENT], check=True)
    subprocess.run([sys.executable, "-m", "pip", "--python", PYTHON, "install", "--quiet", "--no-compile", "--disable-pip-version-check",
                    "--no-deps", "--require-hashes", "--only-binary=:all:", "-r", REQUIREMENTS], check=True)
    stamp.write_text(version)


def gather(pages, site):
    """Writes the pages and MkDocs' configuration for a site into the folder `pages`."""
    subprocess.run([PYTHON, HERE / "pages.py", pages, site], check=True)


def build(pages):
    """Builds the site from gathered pages. Broken links and pages missing from docs/README.md are errors."""
    done = subprocess.run([PYTHON, "-m", "mkdocs", "build", "--strict", "--clean", "--config-file", pages / "mkdocs.yml"],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, env={**os.environ, "NO_MKDOCS_2_WARNING": "1"})
    if done.returncode != 0:
        raise ValueError("the documentation site has faults:\n" + re.sub(r"^INFO .*\n", "", done.stdout + done.stderr, flags=re.M))


class Handler(http.server.SimpleHTTPRequestHandler):
    extensions_map = http.server.SimpleHTTPRequestHandler.extensions_map | {".toml": "text/plain; charset=utf-8"}  # shown, not downloaded

    def log_message(self, *_):
        """Requests are not logged."""


def serve(site, port):
    handler = functools.partial(Handler, directory=site)
    with http.server.ThreadingHTTPServer(("127.0.0.1", port), handler) as server:
        say(f"http://127.0.0.1:{server.server_address[1]}/ (Ctrl-C ends)")
        server.serve_forever()


def main():
    parser = argparse.ArgumentParser(prog="./gloam docs", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--serve", action="store_true", help="serve the site on 127.0.0.1 after building it")
    parser.add_argument("--port", type=int, default=8000, help="port of --serve; 0 chooses a free one (default: 8000)")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "site", help="output folder (default: build/site)")
    args = parser.parse_args()
    site = args.out.resolve()
    pages = site.parent / f"{site.name}_pages"
    install()
    gather(pages, site)
    build(pages)
    print(site / "index.html", flush=True)
    if args.serve:
        serve(site, args.port)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, ValueError, subprocess.CalledProcessError) as problem:
        say(f"error: {problem}")
        sys.exit(1)
    except KeyboardInterrupt:
        sys.exit(130)
