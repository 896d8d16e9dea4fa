"""The command line of gloam bench real and gloam real."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest
from real_fixtures import write_network, write_set

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def commands() -> ModuleType:
    spec = importlib.util.spec_from_file_location("real_commands", ROOT / "tools" / "real" / "commands.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_comparison(commands: ModuleType, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    network = str(write_network(tmp_path / "network"))
    real, sim, flat = (str(write_set(tmp_path / name, 3, seed=k)) for k, name in enumerate(("real", "sim", "flat")))
    out = str(tmp_path / "out")
    line = ["bench", real, sim, "--pairs", "--baseline", f"flat={flat}", "--network", network, "--out", out, "--examples", "1"]
    assert commands.main(line) == 0
    assert f"{out}/report.html" in capsys.readouterr().out
    (Path(sim) / "bad.png").write_text("x")
    (Path(real) / "bad.png").write_text("x")
    assert commands.main(line) == 3
    assert "2 files were left out" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--baseline", "flat"], "--baseline is NAME=DIR"),
        (["--baseline", "simulation=x"], "a name of its own"),
        ([], "no network is installed"),
        (["--network", "none", "--temperature", "0"], "temperature"),
    ],
)
def test_wrong_calls(
    commands: ModuleType,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    words: str,
) -> None:
    monkeypatch.setenv("GLOAM_REAL_ENVIRONMENTS", str(tmp_path))
    assert commands.main(["bench", str(tmp_path), str(tmp_path), "--out", str(tmp_path / "out"), *arguments]) == 2
    assert words in capsys.readouterr().err
    assert commands.main(["install", "clip"]) == 2
    assert commands.main(["convert", "clip", str(tmp_path / "none.pt"), "-o", str(tmp_path)]) == 1
    assert commands.main(["networks"]) == 0 and "./gloam real install" in capsys.readouterr().out


def test_the_tests_have_the_packages_of_the_command() -> None:
    """The environment of the tests must not hide that a list lacks a package or has another version."""

    def entries(file: Path) -> set[str]:
        return {line.split()[0] for line in file.read_text().splitlines() if "==" in line}

    assert entries(ROOT / "tools/real/requirements.txt") <= entries(ROOT / "tests/python/requirements.txt")
    assert sys.version_info >= (3, 11)
