"""Order, distribution and progress of tests of Python. `pytest -n 2` runs two files at a time, those that take longest first."""

from __future__ import annotations

from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

import pytest

# Files of over ten seconds. Others follow in the order of their names.
LONGEST = """docs_test gallery_test source_checks foxglove_test cli_test evaluate_test hostile_test bench_test
test_slam_benchmark test_wheel test_navigation_benchmark test_stuck test_examples test_slam_adapters""".split()
APART = ("docs_test", "source_checks")  # files whose tests share nothing: each may run in another process


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    ranks = {name: rank for rank, name in enumerate(LONGEST)}
    items.sort(key=lambda item: ranks.get(item.path.stem, len(LONGEST)))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    from xdist.scheduler import LoadScopeScheduling

    class Scheduling(LoadScopeScheduling):
        """Keeps the tests of a file in one process, because they share fixtures."""

        def _split_scope(self, nodeid: str) -> str:
            file = nodeid.split("::")[0]
            return nodeid if Path(file).stem in APART else file

    return Scheduling(config, log)


class Progress:
    """Prints a line for each file once all its tests have run, and those of its tests that failed."""

    def __init__(self, config: pytest.Config) -> None:
        self.config = config
        self.expected: Counter[str] = Counter()
        self.outcomes: defaultdict[str, Counter[str]] = defaultdict(Counter)
        self.seconds: Counter[str] = Counter()

    def expect(self, ids: list[str]) -> None:
        self.expected = Counter(nodeid.split("::")[0] for nodeid in ids)

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_node_collection_finished(self, ids: list[str]) -> None:
        self.expect(ids)

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        self.expect([item.nodeid for item in session.items])

    @pytest.hookimpl(tryfirst=True)  # before the letters of subtests
    def pytest_report_teststatus(self, report: pytest.TestReport) -> tuple[str, str, str]:
        """The category of the test in the last line; no letter."""
        if report.when != "call":
            return ("error" if report.failed else report.outcome if report.skipped else "", "", "ERROR")
        return (report.outcome, "", report.outcome.upper())

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.passed and hasattr(report, "context"):  # a subtest, which is a part of a test
            return
        file = report.nodeid.split("::")[0]
        self.seconds[file] += report.duration
        outcomes = self.outcomes[file]
        if report.when == "call" and report.passed:
            outcomes["passed"] += 1
        elif not report.passed:
            outcomes[report.outcome] += 1
        if report.when == "teardown":
            outcomes["done"] += 1
            if outcomes["done"] == self.expected[file]:
                counts = ", ".join(f"{outcomes[name]} {name}" for name in ("passed", "failed", "skipped") if outcomes[name])
                line = f"{'FAIL' if outcomes['failed'] else 'ok  '} {file:<44} {counts:<34} {self.seconds[file]:6.1f} s"
                self.config.get_terminal_writer().line(line)
                self.config.get_terminal_writer().flush()


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("--progress") and not hasattr(config, "workerinput"):
        config.pluginmanager.register(Progress(config))


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--progress", action="store_true", help="print a line with counts and seconds for each file instead of dots")
