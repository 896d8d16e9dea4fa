"""Numbers and tests in words, as the page prints them."""

from __future__ import annotations

from .results import Results
from .statistics import Estimate
from .summary import CellSummary, PairedTest, Summary

ALPHA = 0.05
NONE = "–"


def number(value: float | None, digits: int = 2) -> str:
    """Fixed digits with a proper minus sign; "–" for None."""
    if value is None:
        return NONE
    text = f"{value:.{digits}f}"
    # -0.00 would suggest a direction.
    return text.lstrip("-") if float(text) == 0 else text.replace("-", "−")


def interval(estimate: Estimate, digits: int = 2) -> str:
    """ "[0.62, 0.92]"; "" without an interval; "all equal" where resampling cannot show a spread."""
    if estimate.low is None or estimate.high is None:
        return ""
    if estimate.constant:
        return "all equal"
    return f"[{number(estimate.low, digits)}, {number(estimate.high, digits)}]"


def percent(share: float | None) -> str:
    """A share in percent with one digit; "–" for None, "< 0.1 %" for a small one that is not 0."""
    if share is None:
        return NONE
    return "< 0.1 %" if 0 < share < 0.001 else f"{100 * share:.1f} %"


def duration(seconds: float | None) -> str:
    """ "42 s", "12 min", "3.4 h"; "–" for None."""
    if seconds is None:
        return NONE
    if seconds < 120:
        return f"{seconds:.1f} s" if seconds < 10 else f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


def p_value(p: float | None) -> str:
    """ "= 0.031", "< 0.001"; "–" for None."""
    if p is None:
        return NONE
    return "< 0.001" if p < 0.001 else f"= {p:.3f}"


def success_words(test: PairedTest) -> str:
    """Result of McNemar's test in a sentence."""
    first, second = (f"“{name}”" for name in (test.first, test.second))
    if test.success_p is None:
        return "No episode is finished in both."
    if test.first_only == test.second_only == 0:
        return f"Both have the same outcome in all {_pairs(test)}: {test.both} successes."
    return (
        f"Of {_pairs(test)}, {test.first_only} succeeded only with {first}, {test.second_only} only with {second}, "
        f"{test.both} with both."
    )


def sc_words(test: PairedTest) -> str:
    """Mean difference of SC with its interval in a sentence."""
    value = test.sc.value
    if value is None:
        return ""
    brackets = interval(test.sc)
    change = "SC is equal on average" if abs(value) < 0.005 else (
        f"SC is {number(abs(value))} {'higher' if value > 0 else 'lower'} with “{test.second}”"
    )  # fmt: skip
    return f"{change} (difference {number(value)}{' ' + brackets if brackets else ''})."


def verdict(test: PairedTest) -> str:
    """ "clear", "no clear difference", or the reason for which the test cannot decide."""
    if test.success_p is None:
        return "no pairs"
    if test.least_p > ALPHA:
        return f"too few pairs: p cannot be below {number(test.least_p, 3)}"
    clear = [name for name, p in (("success", test.success_holm), ("SC", test.sc_holm)) if p is not None and p < ALPHA]
    return f"clear difference in {' and '.join(clear)}" if clear else "no clear difference"


def is_clear(test: PairedTest) -> bool:
    """Whether an adjusted p-value is below 0.05."""
    return any(p is not None and p < ALPHA for p in (test.success_holm, test.sc_holm))


def findings(results: Results, summary: Summary) -> list[str]:
    """Sentences for the top of the page: the best planner of each scene and level, and the effect of the levels."""
    sentences = []
    for scene in results.request.scenes:
        parts = []
        for level in results.request.levels:
            cells = [c for c in summary.cells if (c.scene, c.level) == (scene, level) and c.sc.value is not None]
            if cells:
                parts.append(_best(level, cells))
        if parts:
            sentences.append(f"{scene}, highest mean SC: {'; '.join(parts)}.")
    for kind, subject in (("levels", "between levels of one planner"), ("planners", "between planners at one level")):
        tests = [t for t in summary.tests if t.kind == kind]
        if tests:
            clear = sum(map(is_clear, tests))
            sentences.append(f"{clear} of {len(tests)} comparisons {subject} show a clear difference (Holm-adjusted p < 0.05).")
    return sentences


def _best(level: str, cells: list[CellSummary]) -> str:
    top = max(c.sc.value or 0.0 for c in cells)
    if top == 0:
        return f"{level}: no success"
    names = [c.planner for c in cells if c.sc.value == top]
    return f"{level}: {' and '.join(names)} with {number(top)}"


def _pairs(test: PairedTest) -> str:
    return f"{test.pairs} {'pair' if test.pairs == 1 else 'pairs'}"
