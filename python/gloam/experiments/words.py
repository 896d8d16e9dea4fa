"""Numbers in words, as the pages print them."""

from __future__ import annotations

import time

from .statistics import Estimate

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


def count(number: int, noun: str) -> str:
    """ "1 collision", "2 collisions"; the plural of "success" is "successes"."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}{'es' if noun.endswith('s') else 's'}"


class Remaining:
    """Estimates the time that is left for a number of parts, from the time of those that are done."""

    def __init__(self, total: int) -> None:
        self._begin, self._total = time.monotonic(), total

    def after(self, done: int) -> str:
        """ ", 12 min left", or "" before the first part is done."""
        left = (time.monotonic() - self._begin) / done * (self._total - done) if done else None
        return "" if left is None else f", {duration(left)} left"
