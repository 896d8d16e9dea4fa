"""Metrics of each cell (planner, scene, level) and paired tests between cells."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Literal

from gloam.experiments.statistics import Estimate, bootstrap_mean, generator, holm, mcnemar, sign_flip, wilson
from gloam.experiments.videos import median_and_worst

from .key import Key
from .results import Episode, Results

ALPHA = 0.05


@dataclass(frozen=True)
class CellSummary:
    """Metrics of one cell over its finished episodes, with 95 % intervals.

    success: rate (Wilson); sc, spl: in [0, 1]; collisions: per episode; time: to the goal over successes only [s];
    distance: to the goal at the end [m] (bootstrap). visibility_mean: over episodes that know it, visibility_min: their
    least [m]; late, invalid: share of all answers in [0, 1]; wall, cpu: mean cost of an episode [s]; None if unknown.
    outcomes: count by outcome; objects: collisions by object; errors: episodes that ended with an error, which count as
    failures; worst, median: by SC, then by final distance; None without episodes.
    """

    planner: str
    scene: str
    level: str
    requested: int
    finished: int
    pending: tuple[int, ...]
    success: Estimate
    sc: Estimate
    spl: Estimate
    collisions: Estimate
    time: Estimate
    distance: Estimate
    visibility_mean: float | None
    visibility_min: float | None
    late: float | None
    invalid: float | None
    wall: float | None
    cpu: float | None
    tiers: tuple[str, ...]
    outcomes: dict[str, int]
    objects: dict[str, int]
    errors: tuple[Episode, ...]
    worst: Episode | None
    median: Episode | None

    @property
    def name(self) -> str:
        """ "planner/scene/level"."""
        return f"{self.planner}/{self.scene}/{self.level}"

    @property
    def successes(self) -> int:
        """Number of successful episodes."""
        return self.outcomes.get("success", 0)


@dataclass(frozen=True)
class PairedTest:
    """Comparison of two cells of one scene over the episodes that both have finished, paired by index.

    kind: "levels" (one planner, first and second are levels) or "planners" (one level, first and second are planners);
    common: the planner or level of both; first_only, second_only, both: pairs by success; sc: mean of second − first;
    *_p: p-values, *_holm: adjusted within the kind; None without pairs.
    """

    kind: Literal["levels", "planners"]
    scene: str
    common: str
    first: str
    second: str
    pairs: int
    both: int
    first_only: int
    second_only: int
    sc: Estimate
    success_p: float | None
    sc_p: float | None
    success_holm: float | None = None
    sc_holm: float | None = None

    @property
    def least_p(self) -> float:
        """Smallest p-value that this number of pairs can give: all pairs differ in one direction."""
        return min(1.0, 2.0 ** (1 - self.pairs))

    @property
    def is_clear(self) -> bool:
        """Whether an adjusted p-value is below ALPHA."""
        return any(p is not None and p < ALPHA for p in (self.success_holm, self.sc_holm))


@dataclass(frozen=True)
class Summary:
    """All cells in the order of Request.cells() and all paired tests, levels first."""

    cells: tuple[CellSummary, ...]
    tests: tuple[PairedTest, ...]

    def cell(self, planner: str, scene: str, level: str) -> CellSummary:
        """The cell of that name. Errors: KeyError."""
        for cell in self.cells:
            if (cell.planner, cell.scene, cell.level) == (planner, scene, level):
                return cell
        raise KeyError(f"{planner}/{scene}/{level}")


def summarize(results: Results) -> Summary:
    """Computes the metrics of all cells and the paired tests. The seed of the request determines all random numbers."""
    request = results.request
    episodes = {name: results.cell(*name) for name in request.cells()}
    pending: dict[tuple[str, str, str], list[Key]] = {}
    for key in results.pending:
        pending.setdefault((key.planner, key.scene, key.level), []).append(key)
    cells = tuple(
        _cell(name, episodes[name], tuple(key.episode for key in pending.get(name, [])), request.seed)
        for name in episodes
    )
    tests: list[PairedTest] = []
    for pairs in (_level_pairs(results), _planner_pairs(results)):
        tests += _adjust([_test(pair, episodes[first], episodes[second], request.seed) for pair, first, second in pairs])
    return Summary(cells, tuple(tests))


def _cell(
    name: tuple[str, str, str], episodes: list[Episode], pending: tuple[int, ...], seed: int
) -> CellSummary:
    def estimate(metric: str, value: Callable[[Episode], float], of: Iterable[Episode] = episodes) -> Estimate:
        return bootstrap_mean([value(e) for e in of], generator(seed, "/".join((*name, metric))))

    def mean(values: list[float]) -> float | None:
        return sum(values) / len(values) if values else None

    plans = sum(e.plans for e in episodes)
    outcomes = Counter(e.outcome for e in episodes)
    objects: Counter[str] = Counter()
    for episode in episodes:
        objects.update({name: count for name, count in episode.collisions_by_object.items() if count})
        if unknown := episode.collisions - sum(episode.collisions_by_object.values()):
            objects["(unknown)"] += unknown
    median, worst = median_and_worst_of(episodes)
    least = [e.visibility_min for e in episodes if e.visibility_min is not None]
    return CellSummary(
        *name,
        requested=len(episodes) + len(pending),
        finished=len(episodes),
        pending=pending,
        success=wilson(outcomes["success"], len(episodes)),
        sc=estimate("sc", lambda e: e.sc),
        spl=estimate("spl", lambda e: e.spl),
        collisions=estimate("collisions", lambda e: e.collisions),
        time=estimate("time", lambda e: e.time, [e for e in episodes if e.success]),
        distance=estimate("distance", lambda e: e.final_distance),
        visibility_mean=mean([e.visibility_mean for e in episodes if e.visibility_mean is not None]),
        visibility_min=min(least, default=None),
        late=sum(e.late for e in episodes) / plans if plans else None,
        invalid=sum(e.invalid for e in episodes) / plans if plans else None,
        wall=mean([e.wall_seconds for e in episodes]),
        cpu=mean([e.cpu_seconds for e in episodes]),
        tiers=tuple(sorted({e.tier for e in episodes})),
        outcomes=dict(outcomes),
        objects=dict(sorted(objects.items(), key=lambda item: (-item[1], item[0]))),
        errors=tuple(e for e in episodes if e.outcome == "error"),
        worst=worst,
        median=median,
    )


def median_and_worst_of(episodes: list[Episode]) -> tuple[Episode | None, Episode | None]:
    """The median episode of a cell and its worst one, by SC, then by final distance, then by number; None without any."""
    return median_and_worst(episodes, lambda e: (e.sc, -e.final_distance, e.key.episode)) or (None, None)


_Cell = tuple[str, str, str]
_Pair = tuple[Literal["levels", "planners"], str, str, str, str]  # kind, scene, common, first, second


def _level_pairs(results: Results) -> Iterator[tuple[_Pair, _Cell, _Cell]]:
    request = results.request
    for scene in request.scenes:
        for planner in request.planners:
            for first, second in combinations(request.levels, 2):
                yield ("levels", scene, planner, first, second), (planner, scene, first), (planner, scene, second)


def _planner_pairs(results: Results) -> Iterator[tuple[_Pair, _Cell, _Cell]]:
    request = results.request
    for scene in request.scenes:
        for level in request.levels:
            for first, second in combinations(request.planners, 2):
                yield ("planners", scene, level, first, second), (first, scene, level), (second, scene, level)


def _test(pair: _Pair, first: list[Episode], second: list[Episode], seed: int) -> PairedTest:
    others = {e.key.episode: e for e in second}
    pairs = [(e, others[e.key.episode]) for e in first if e.key.episode in others]
    first_only = sum(a.success and not b.success for a, b in pairs)
    second_only = sum(b.success and not a.success for a, b in pairs)
    differences = [b.sc - a.sc for a, b in pairs]
    name = "/".join(("test", *pair))
    return PairedTest(
        *pair,
        pairs=len(pairs),
        both=sum(a.success and b.success for a, b in pairs),
        first_only=first_only,
        second_only=second_only,
        sc=bootstrap_mean(differences, generator(seed, name)),
        success_p=mcnemar(first_only, second_only) if pairs else None,
        sc_p=sign_flip(differences, generator(seed, name + "/flips")) if pairs else None,
    )


def _adjust(tests: list[PairedTest]) -> list[PairedTest]:
    """Holm's correction over both tests of all comparisons of one kind."""
    known = [t for t in tests if t.success_p is not None and t.sc_p is not None]
    adjusted = holm([p for t in known for p in (t.success_p, t.sc_p) if p is not None])
    of = {id(t): (adjusted[2 * i], adjusted[2 * i + 1]) for i, t in enumerate(known)}
    return [replace(t, success_holm=of[id(t)][0], sc_holm=of[id(t)][1]) if id(t) in of else t for t in tests]
