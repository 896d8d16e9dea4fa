"""Evaluation of the visual navigation benchmark: episode files, statistics, tables and a page."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .report import write_report
    from .request import Request
    from .results import Episode, Results, load_results
    from .summary import CellSummary, PairedTest, Summary, summarize

__all__ = [
    "CellSummary",
    "Episode",
    "PairedTest",
    "Request",
    "Results",
    "Summary",
    "load_results",
    "summarize",
    "write_report",
]

_HOMES = {
    "Request": "request",
    **dict.fromkeys(("Episode", "Results", "load_results"), "results"),
    **dict.fromkeys(("CellSummary", "PairedTest", "Summary", "summarize"), "summary"),
    "write_report": "report",
}


def __getattr__(name: str) -> Any:
    # Imported on first use, because `python -m gloam.navigation.benchmark.report` imports this package first and would
    # otherwise run the module twice.
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f".{_HOMES[name]}", __name__), name)
