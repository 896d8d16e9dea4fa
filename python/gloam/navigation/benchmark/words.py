"""Numbers and tests in words, as the page prints them."""

from __future__ import annotations

from collections.abc import Sequence

from .statistics import Estimate
from .summary import PairedTest

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
    return f"[{number(estimate.low, digits)},\u00a0{number(estimate.high, digits)}]"  # no line break inside


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
        return f"Both have the same outcome in {'all ' if test.pairs > 1 else ''}{count(test.pairs, 'pair')}: {count(test.both, 'success')}."
    return (
        f"Successes in {count(test.pairs, 'pair')}: {test.first_only} only with {first}, {test.second_only} only with {second}, "
        f"{test.both} with both."
    )


def sc_words(test: PairedTest) -> str:
    """Mean difference of SC with its interval in a sentence."""
    value = test.sc.value
    if value is None:
        return ""
    brackets = interval(test.sc)
    numbers = f"{number(value)}\u00a0{brackets}".strip()
    if abs(value) < 0.005:
        return f"The mean SC is equal: difference {numbers}."
    return f"SC is {'higher' if value > 0 else 'lower'} with “{test.second}”: {numbers}."


def verdict(test: PairedTest) -> str:
    """The direction of clear differences, "no clear difference", or the reason for which the test cannot decide."""
    if test.success_p is None or test.sc.value is None:
        return "no pairs"
    if test.least_p > ALPHA:
        return f"too few pairs: p cannot be below {number(test.least_p, 3)}"
    differences = (
        ("success", test.success_holm, test.second_only - test.first_only),
        ("SC", test.sc_holm, test.sc.value),
    )
    clear = [(name, change > 0) for name, p, change in differences if p is not None and p < ALPHA]
    ways = [f"{' and '.join(n for n, up in clear if up == way)} {'higher' if way else 'lower'}"
            for way in (True, False) if any(up == way for _, up in clear)]  # fmt: skip
    return f"{', '.join(ways)} with “{test.second}”" if ways else "no clear difference"


def is_clear(test: PairedTest) -> bool:
    """Whether an adjusted p-value is below 0.05."""
    return any(p is not None and p < ALPHA for p in (test.success_holm, test.sc_holm))


def power_note(family: list[PairedTest]) -> str:
    """A sentence if no test of a family can have an adjusted p below 0.05, because the smallest p-value of its pairs times
    the number of tests is larger; "" otherwise."""
    known = [test for test in family if test.success_p is not None]
    tests = 2 * len(known)
    if not known or tests * min(test.least_p for test in known) < ALPHA:
        return ""
    needed = next(n for n in range(1, 100) if tests * 2.0 ** (1 - n) < ALPHA)
    return (
        f"No result can be clear here: with {count(max(test.pairs for test in known), 'pair')} and {tests} tests, no adjusted p can "
        f"be below 0.05. At least {needed} episodes per cell are needed."
    )


def numbers(values: Sequence[int]) -> str:
    """Increasing numbers as ranges: "3, 17–19"."""
    parts: list[list[int]] = []
    for value in values:
        if parts and value == parts[-1][-1] + 1:
            parts[-1].append(value)
        else:
            parts.append([value])
    return ", ".join(str(part[0]) if len(part) == 1 else f"{part[0]}{', ' if len(part) == 2 else '–'}{part[-1]}" for part in parts)


def episodes(values: Sequence[int], requested: int) -> str:
    """ "all 5 episodes", "both episodes", "episode 3", "episodes 3, 17–19"."""
    if len(values) == requested:
        return {1: "the only episode", 2: "both episodes"}.get(requested, f"all {requested} episodes")
    return f"{'episode' if len(values) == 1 else 'episodes'} {numbers(values)}"


def count(number: int, noun: str) -> str:
    """ "1 collision", "2 collisions"; the plural of "success" is "successes"."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}{'es' if noun.endswith('s') else 's'}"
