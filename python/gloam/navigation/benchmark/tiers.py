"""Whether the tier of images changes results: the first episodes of each cell once more with the path tier."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import gloam
from gloam.experiments.files import replace_file
from gloam.experiments.statistics import Estimate, bootstrap_mean, generator, mcnemar, sign_flip
from gloam.experiments.tables import estimate_columns, write_csv
from gloam.experiments.words import interval, number, p_value

from .options import check_planners
from .request import Request
from .results import Episode, Results, load_results

TIER = "path"
FOLDER = "path_tier"  # in the folder of the benchmark: a benchmark of its own
FILE = "tiers.csv"
ALL = "(all)"


@dataclass(frozen=True)
class TierRow:
    """One cell, or all cells of a planner, over the episodes that are finished in both tiers.

    same_outcome, successes, path_successes: episodes; sc, path_sc: means in [0, 1], None without pairs; difference: of SC,
    path tier − first tier; success_p, sc_p: paired tests (McNemar, sign flips) without a correction, None without pairs.
    """

    planner: str
    scene: str
    level: str
    pairs: int
    same_outcome: int
    successes: int
    path_successes: int
    sc: float | None
    path_sc: float | None
    difference: Estimate
    success_p: float | None
    sc_p: float | None


def tier_request(request: Request, episodes: int) -> Request:
    """The same benchmark with the path tier: `episodes` of each cell, and only the planners that see images: episodes of
    the others are equal in all tiers. Errors: gloam.UsageError if no planner sees images, or nothing can be
    compared."""
    if request.tier == TIER:
        raise gloam.UsageError("the benchmark uses the path tier already, so there is nothing to compare")
    if not 1 <= episodes <= request.episodes:
        raise gloam.UsageError(f"the tier can be checked with 1 to {request.episodes} episodes, got {episodes}")
    made = check_planners(request.planners, request.options)
    planners = tuple(name for name in request.planners if made[name].needs & {"image", "depth"})
    if not planners:
        raise gloam.UsageError(f"the tier does not matter to {', '.join(request.planners)}: none needs images")
    options = tuple(option for option in request.options if option.planner in planners)
    return replace(request, planners=planners, episodes=episodes, tier=TIER, options=options)


def tier_rows(folder: Path) -> list[TierRow]:
    """A row for each cell and one for each planner, or [] if the tier has not been checked. Errors: as load_results()."""
    if not (folder / FOLDER).is_dir():
        return []
    return list(_rows(load_results(folder), load_results(folder / FOLDER)))


def _rows(first: Results, path: Results) -> Iterator[TierRow]:
    seed = first.request.seed
    others = {episode.key: episode for episode in path.episodes}
    pairs = [(episode, others[episode.key]) for episode in first.episodes if episode.key in others]
    for planner, scene, level in path.request.cells():
        chosen = [p for p in pairs if (p[0].key.planner, p[0].key.scene, p[0].key.level) == (planner, scene, level)]
        yield _row((planner, scene, level), chosen, seed)
    for planner in path.request.planners:
        yield _row((planner, ALL, ALL), [p for p in pairs if p[0].key.planner == planner], seed)


def _row(cell: tuple[str, str, str], pairs: Sequence[tuple[Episode, Episode]], seed: int) -> TierRow:
    name = "/".join(("tiers", *cell))
    differences = [b.sc - a.sc for a, b in pairs]
    return TierRow(
        *cell,
        pairs=len(pairs),
        same_outcome=sum(a.outcome == b.outcome for a, b in pairs),
        successes=sum(a.success for a, _ in pairs),
        path_successes=sum(b.success for _, b in pairs),
        sc=sum(a.sc for a, _ in pairs) / len(pairs) if pairs else None,
        path_sc=sum(b.sc for _, b in pairs) / len(pairs) if pairs else None,
        difference=bootstrap_mean(differences, generator(seed, name)),
        success_p=_mcnemar(pairs) if pairs else None,
        sc_p=sign_flip(differences, generator(seed, name + "/flips")) if pairs else None,
    )


def _mcnemar(pairs: Sequence[tuple[Episode, Episode]]) -> float:
    return mcnemar(sum(a.success and not b.success for a, b in pairs), sum(b.success and not a.success for a, b in pairs))


def write_tiers(folder: Path) -> list[TierRow]:
    """Writes tiers.csv into the folder of a benchmark whose tier has been checked. Errors: as load_results()."""
    rows = tier_rows(folder)
    replace_file(folder / FILE, lambda path: write_csv(path, [_columns(row) for row in rows]))
    return rows


def _columns(row: TierRow) -> dict[str, object]:
    values = dict(vars(row))
    del values["difference"]
    return values | estimate_columns("difference", row.difference)


def tier_lines(rows: Sequence[TierRow], tier: str) -> list[str]:
    """A table for a terminal. tier: of the benchmark."""
    head = ("planner", "scene", "level", "same outcome", f"success {tier}/path", f"SC {tier}", "SC path", "difference", "p")
    lines = [head, *(_cells(row) for row in rows)]
    widths = [max(len(line[i]) for line in lines) for i in range(len(head))]
    return ["  ".join(text.ljust(width) for text, width in zip(line, widths, strict=True)).rstrip() for line in lines]


def _cells(row: TierRow) -> tuple[str, ...]:
    return (
        row.planner, row.scene, row.level, f"{row.same_outcome} of {row.pairs}", f"{row.successes}/{row.path_successes}",
        number(row.sc), number(row.path_sc), f"{number(row.difference.value)} {interval(row.difference)}".replace("\u00a0", " ").strip(),
        p_value(row.sc_p).removeprefix("= "),
    )  # fmt: skip
