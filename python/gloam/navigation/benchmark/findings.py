"""Sentences at the top of the page: the effect of adversity, the best planners, and the reliability of both."""

from __future__ import annotations

from gloam.experiments.words import count, interval, number

from .results import Results
from .summary import CellSummary, Summary
from .words import power_note


def findings(results: Results, summary: Summary) -> list[str]:
    """One sentence each, most important first. Cells without a finished episode are left out."""
    scenes = results.request.scenes
    sentences = [*(_effect(results, summary, scene) for scene in scenes), *(_best(results, summary, scene) for scene in scenes)]
    sentences += _reliability(summary)
    sentences += [_broken(summary, planner) for planner in results.request.planners]
    return [sentence for sentence in sentences if sentence]


def _effect(results: Results, summary: Summary, scene: str) -> str:
    """Successes and SC at the first and the last level."""
    levels = results.request.levels
    if len(levels) < 2:
        return ""
    parts = []
    for planner in results.request.planners:
        first, last = (summary.cell(planner, scene, level) for level in (levels[0], levels[-1]))
        if first.finished and last.finished and not _is_broken(summary, planner):
            successes = f"{first.successes} of {first.finished} → {last.successes} of {last.finished}"
            parts.append(f"{planner} {successes} (SC {number(first.sc.value)} → {number(last.sc.value)})")
    return f"Successes in {scene} from “{levels[0]}” to “{levels[-1]}”: {', '.join(parts)}." if parts else ""


def _best(results: Results, summary: Summary, scene: str) -> str:
    """The planners with the highest SC at each level."""
    parts = []
    for level in results.request.levels:
        cells = [c for c in summary.cells if (c.scene, c.level) == (scene, level) and c.sc.value is not None]
        if cells:
            parts.append(_top(level, cells))
    return f"Highest mean SC in {scene}: {_listed(parts)}." if parts else ""


def _top(level: str, cells: list[CellSummary]) -> str:
    top = max(c.sc.value or 0.0 for c in cells)
    if top == 0:
        return f"no planner at “{level}” (no success)"
    best = [c for c in cells if c.sc.value == top]
    brackets = interval(best[0].sc) if len(best) == 1 and not best[0].sc.constant else ""
    return f"{' and '.join(c.planner for c in best)} at “{level}” ({f'{number(top)} {brackets}'.rstrip()})"


def _listed(parts: list[str]) -> str:
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"


def _reliability(summary: Summary) -> list[str]:
    sentences, weak = [], []
    for kind, subject in (("levels", "between levels of one planner"), ("planners", "between planners at one level")):
        tests = [t for t in summary.tests if t.kind == kind]
        if tests and power_note(tests):
            weak.append(subject)
        elif tests:
            clear = sum(test.is_clear for test in tests)
            shows = f"{clear or 'None'} of {count(len(tests), 'comparison')} {subject} {'show' if clear > 1 else 'shows'}"
            sentences.append(f"{shows} a clear difference (Holm-adjusted p < 0.05).")
    return sentences + ([f"There are too few episodes for clear differences {' and '.join(weak)}."] if weak else [])


def _broken(summary: Summary, planner: str) -> str:
    if not _is_broken(summary, planner):
        return ""
    return f"{planner} ended with an error in all its episodes, so its figures do not measure the planner (see Errors)."


def _is_broken(summary: Summary, planner: str) -> bool:
    """Whether a planner never ran: its zeros are not a result."""
    cells = [c for c in summary.cells if c.planner == planner]
    return 0 < sum(c.finished for c in cells) == sum(len(c.errors) for c in cells)
