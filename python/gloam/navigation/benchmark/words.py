"""Tests and episodes in words, as the page prints them."""

from __future__ import annotations

from collections.abc import Sequence

from gloam.experiments.words import count, interval, number

from .summary import ALPHA, PairedTest


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
