"""Evaluation of the navigation benchmark: statistics in closed form, input errors, tables and the page."""

from __future__ import annotations

import csv
import json
import math
import random
from itertools import product
from pathlib import Path

import gloam
import navigation_recompute
import numpy as np
import pytest
from gloam.experiments import statistics
from gloam.experiments import words as shared
from gloam.experiments.tables import write_csv
from gloam.navigation.benchmark import Results, Summary, load_results, summarize
from gloam.navigation.benchmark import paper, tables, words
from gloam.navigation.benchmark.findings import findings
from navigation_folder import episode, write_episode, write_folder, write_request

NAME = ("route", "house", "none")


def small(folder: Path, changed: list[dict[str, object]], **request: object) -> tuple[Results, Summary]:
    """One planner in one scene with the given changes of a successful episode."""
    write_request(folder, **{"planners": ["route"], "scenes": ["house"], "levels": ["none"], "episodes": len(changed)} | request)
    for number, changes in enumerate(changed):
        write_episode(folder, episode(*NAME, number, **changes))
    results = load_results(folder)
    return results, summarize(results)


FAIL = {"outcome": "stuck", "success": False}


def test_wilson_interval_of_published_values() -> None:
    # Newcombe 1998, table I, method 3: 81/263 → [0.2553, 0.3662], 15/148 → [0.0624, 0.1605], 0/20 → [0, 0.1611].
    for good, count, low, high in [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)]:
        estimate = statistics.wilson(good, count)
        assert (estimate.low, estimate.high) == pytest.approx((low, high), abs=5e-5)
    assert statistics.wilson(20, 20).high == 1.0
    assert statistics.wilson(0, 0) == statistics.Estimate(None, None, None, 0)
    with pytest.raises(ValueError):
        statistics.wilson(3, 2)


def test_bootstrap_covers_the_mean_and_repeats() -> None:
    draw = np.random.default_rng(3)
    inside = 0
    for i in range(300):
        data = list(draw.normal(2.0, 1.0, 40))
        estimate = statistics.bootstrap_mean(data, statistics.generator(1, str(i)), 1000)
        assert estimate.low is not None and estimate.high is not None
        inside += estimate.low <= 2.0 <= estimate.high
    assert 0.90 <= inside / 300 <= 0.98
    first, again, other = (statistics.bootstrap_mean([1.0, 2.0, 5.0, 9.0] * 5, statistics.generator(s, "x")) for s in (1, 1, 2))
    assert first == again and first != other


def test_bootstrap_of_two_values_is_known() -> None:
    # The mean of a resample is 0 or 1 with probability 1/4 each, so the 2.5 % and 97.5 % quantiles are the extremes.
    assert statistics.bootstrap_mean([0.0, 1.0], statistics.generator(0, "")) == statistics.Estimate(0.5, 0.0, 1.0, 2)
    assert statistics.bootstrap_mean([], statistics.generator(0, "")).value is None
    assert statistics.bootstrap_mean([4.0], statistics.generator(0, "")) == statistics.Estimate(4.0, None, None, 1)
    assert statistics.bootstrap_mean([0.3] * 7, statistics.generator(0, "")).constant


def test_bootstrap_in_blocks_keeps_the_distribution(monkeypatch: pytest.MonkeyPatch) -> None:
    data = [float(i) for i in range(50)]
    monkeypatch.setattr(statistics, "_BLOCK", 999)
    estimate = statistics.bootstrap_mean(data, statistics.generator(5, "blocks"))
    error = np.std(data) / math.sqrt(50)
    assert estimate.low == pytest.approx(24.5 - 1.96 * error, abs=0.15 * error)
    assert estimate.high == pytest.approx(24.5 + 1.96 * error, abs=0.15 * error)


def test_mcnemar_against_the_binomial() -> None:
    assert statistics.mcnemar(0, 0) == 1.0
    assert statistics.mcnemar(0, 5) == 2 / 32
    assert statistics.mcnemar(2, 8) == pytest.approx(2 * (1 + 10 + 45) / 1024)
    assert statistics.mcnemar(3, 3) == 1.0
    assert statistics.mcnemar(8, 2) == statistics.mcnemar(2, 8)
    assert statistics.mcnemar(0, 3000) == 0.0  # 2^-2999 is below the smallest float


def test_sign_flips_exactly_and_at_random() -> None:
    draw = random.Random(1)
    for n in (1, 4, 9):
        values = [draw.choice((1 / 2, 1 / 3, -1 / 6, 0.1, -0.7)) for _ in range(n)]
        sums = [abs(sum(s * v for s, v in zip(signs, values, strict=True))) for signs in product((1, -1), repeat=n)]
        expected = sum(s >= abs(sum(values)) - 1e-12 for s in sums) / len(sums)
        assert statistics.sign_flip(values, statistics.generator(0, "")) == pytest.approx(expected)
    assert statistics.sign_flip([0.0, 0.0], statistics.generator(0, "")) == 1.0
    assert statistics.sign_flip([1.0] * 5, statistics.generator(0, "")) == 2 / 32
    many = [draw.choice((1, -1, 0.5)) for _ in range(30)]
    assert statistics.sign_flip(many, statistics.generator(0, "")) == pytest.approx(navigation_recompute.flips(many), abs=0.01)
    assert statistics.sign_flip([1.0] * 40, statistics.generator(0, ""), 999) == 1 / 1000


def test_holm_of_the_textbook_example() -> None:
    # Step-down: 0.005·4, 0.01·3, 0.03·2, then not less than before.
    assert statistics.holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert statistics.holm([0.9, 0.8]) == [1.0, 1.0]
    assert statistics.holm([]) == []


def test_metrics_of_known_episodes(tmp_path: Path) -> None:
    _, summary = small(tmp_path, [
        {"collisions": 1, "collisions_by_object": {"chair": 1}, "path_length": 12.0, "time": 30.0},
        {"path_length": 5.9, "time": 10.0, "visibility_mean": None, "visibility_min": None},  # shorter than the shortest
        FAIL | {"collisions": 3, "collisions_by_object": {"chair": 1, "sofa": 1}, "time": 99.0, "final_distance": 4.0},
        FAIL | {"outcome": "error", "plans": 0, "message": "no map"},
    ])  # fmt: skip
    cell = summary.cells[0]
    assert (cell.success.value, cell.sc.value, cell.spl.value) == pytest.approx((0.5, 1.5 / 4, 1.5 / 4))
    assert (cell.time.value, cell.time.count, cell.collisions.value) == (20.0, 2, 1.0)
    assert cell.distance.value == pytest.approx((0.4 * 3 + 4.0) / 4)
    assert cell.objects == {"chair": 2, "(unknown)": 1, "sofa": 1}
    assert [e.message for e in cell.errors] == ["no map"] and cell.outcomes["error"] == 1
    assert (cell.visibility_mean, cell.visibility_min) == (30.0, 25.0)
    assert cell.worst is not None and cell.worst.key.episode == 2  # SC 0 and farther than episode 3
    assert cell.median is not None and cell.median.key.episode == 0  # the better one of 3 and 0


def test_cells_without_success_with_one_episode_and_at_the_goal(tmp_path: Path) -> None:
    _, summary = small(tmp_path / "none", [FAIL, FAIL])
    cell = summary.cells[0]
    assert cell.time.value is None and (cell.sc.value, cell.sc.low) == (0.0, 0.0) and shared.interval(cell.sc) == "all equal"
    assert cell.success.high == pytest.approx(0.6576, abs=1e-4)
    _, summary = small(tmp_path / "one", [{"shortest": 0.0, "path_length": 0.0}])
    cell = summary.cells[0]
    assert cell.spl == statistics.Estimate(1.0, None, None, 1) and cell.worst == cell.median
    _, summary = small(tmp_path / "moved", [{"shortest": 0.0, "path_length": 2.0}, FAIL | {"shortest": 0.0, "plans": 0}])
    assert summary.cells[0].spl.value == 0.5
    _, summary = small(tmp_path / "pending", [], episodes=3)
    cell = summary.cells[0]
    assert (cell.finished, cell.pending, cell.success.value, cell.late, cell.median) == (0, (0, 1, 2), None, None, None)


def test_pairs_use_the_index_and_finished_episodes(tmp_path: Path) -> None:
    write_request(tmp_path, planners=["route"], scenes=["house"], levels=["none", "minor"], episodes=8)
    for number in range(8):
        write_episode(tmp_path, episode(*NAME, number))
    for number in (7, 5, 3, 1):  # 0, 2, 4, 6 are pending
        write_episode(tmp_path, episode("route", "house", "minor", number, **(FAIL if number > 1 else {"collisions": 1})))
    results = load_results(tmp_path)
    (test,) = summarize(results).tests
    assert (test.kind, test.pairs, test.both, test.first_only, test.second_only) == ("levels", 4, 1, 3, 0)
    assert test.success_p == 0.25 and test.sc.value == pytest.approx(-3.5 / 4) and test.sc_p == 2 / 16
    assert (test.sc_holm, test.success_holm) == (0.25, 0.25)
    assert words.verdict(test) == "too few pairs: p cannot be below 0.125"
    assert [key.episode for key in results.pending] == [0, 2, 4, 6]


def test_words_give_the_direction(tmp_path: Path) -> None:
    write_request(tmp_path, planners=["route"], scenes=["house"], levels=["none", "major"], episodes=12)
    for number in range(12):
        write_episode(tmp_path, episode(*NAME, number))
        write_episode(tmp_path, episode("route", "house", "major", number, **FAIL))
    results = load_results(tmp_path)
    summary = summarize(results)
    (test,) = summary.tests
    assert test.success_p == 2 / 2**12 and test.success_holm == 4 / 2**12
    assert words.verdict(test) == "success and SC lower with “major”"
    assert words.success_words(test) == "Successes in 12 pairs: 12 only with “none”, 0 only with “major”, 0 with both."
    assert findings(results, summary) == [
        "Successes in house from “none” to “major”: route 12 of 12 → 0 of 12 (SC 1.00 → 0.00).",
        "Highest mean SC in house: route at “none” (1.00) and no planner at “major” (no success).",
        "1 of 1 comparison between levels of one planner shows a clear difference (Holm-adjusted p < 0.05).",
    ]
    assert words.power_note([test]) == ""  # 2 tests, p down to 2 / 2^12
    assert words.power_note([test] * 60).endswith("At least 13 episodes per cell are needed.")
    assert shared.number(-0.001) == "0.00" and shared.number(-0.2, 1) == "−0.2" and shared.percent(0.0004) == "< 0.1 %"


def test_different_tasks_of_a_pair_are_reported(tmp_path: Path) -> None:
    write_request(tmp_path, planners=["route"], scenes=["house"], levels=["none", "minor"], episodes=1)
    write_episode(tmp_path, episode(*NAME, 0))
    write_episode(tmp_path, episode("route", "house", "minor", 0), goal=[1.0, 1.0])
    (warning,) = load_results(tmp_path).warnings
    assert "house" in warning and "episode 0" in warning


@pytest.mark.parametrize(("change", "cause"), [
    ({"outcome": "won"}, "'outcome' is 'won'"), ({"time": math.nan}, "NaN"), ({"time": math.inf}, "Infinity"),
    ({"success": False}, "'success' is False"), ({"success": 1}, "true or false"), ({"collisions": 1.5}, "'collisions' must"),
    ({"collisions": True}, "'collisions' must"), ({"path_length": -1}, "at least 0"), ({"start": [0, 0]}, "array of 3"),
    ({"goal": [0, "x"]}, "must be a number"), ({"planner": "gnm"}, "belongs to 'route'"), ({"log": "../../x.mp4"}, "'log'"),
    ({"log": "javascript:alert(1)"}, "'log'"), ({"late": 81}, "80 answers"), ({"hash": None}, "'hash' must be text"),
    ({"collisions_by_object": {"chair": 1}}, "more collisions"), ({"collisions_by_object": {"chair": -1}}, "'chair'"),
    ({"shortest": None}, "'shortest'"), ({"wall_seconds": 10**400}, "finite"),
    ({"track": [[1, 2]]}, "'track' must be an array of arrays"), ({"track": [[1, 2, math.nan]]}, "NaN"), ({"track": None}, "'track'"),
    ({"touches": [[1, 2, 3, 4]]}, "'touches' must"), ({"touches": [[1, 2, "3", "chair"]]}, "'touches' must be a number"),
])  # fmt: skip
def test_wrong_values_name_file_and_cause(tmp_path: Path, change: dict[str, object], cause: str) -> None:
    write_request(tmp_path)
    path = write_episode(tmp_path, episode(*NAME, 0))
    path.write_text(json.dumps(episode(*NAME, 0) | change))
    with pytest.raises(gloam.InputError) as error:
        load_results(tmp_path)
    assert cause in str(error.value) and str(path) in str(error.value)


@pytest.mark.parametrize("key", list(episode(*NAME, 0)))
def test_a_missing_key_is_named(tmp_path: Path, key: str) -> None:
    write_request(tmp_path)
    values = episode(*NAME, 0)
    path = write_episode(tmp_path, values)
    path.write_text(json.dumps({k: v for k, v in values.items() if k != key}))
    with pytest.raises(gloam.InputError, match=f"'{key}' is missing"):
        load_results(tmp_path)


def test_wrong_files_and_requests(tmp_path: Path) -> None:
    with pytest.raises(gloam.IoError, match="the folder does not exist"):
        load_results(tmp_path / "absent")
    with pytest.raises(gloam.IoError, match="request.json"):
        load_results(tmp_path)
    for text in ("{", "[]", "\ud800".encode("utf-8", "surrogatepass"), "[" * 100_000):
        (tmp_path / "request.json").write_bytes(text if isinstance(text, bytes) else text.encode())
        with pytest.raises(gloam.InputError, match="request.json"):
            load_results(tmp_path)
    wrong = {"planners": ([], ["a/b"], [1]), "scenes": ([".."], "house", ["a\0"]), "levels": (["x", "x"],), "episodes": (0, True)}
    for change in [{name: value} for name, values in wrong.items() for value in values]:
        write_request(tmp_path, **change)
        with pytest.raises(gloam.InputError, match=f"'{next(iter(change))}'"):
            load_results(tmp_path)
    write_request(tmp_path, episodes=1)
    write_episode(tmp_path, episode(*NAME, 1))
    with pytest.raises(gloam.InputError, match="does not contain this episode"):
        load_results(tmp_path)


def test_the_paper_table_agrees_with_its_own_definition() -> None:
    assert len(paper.TABLE) == 12
    for row in paper.TABLE:
        assert row.success * paper.RUNS == row.successes
        assert row.sc <= row.success  # S / (1 + c) is at most S
    assert [row.planner for row in paper.paper_rows("House_small", "minor")] == ["GNM", "ViNT"]
    assert paper.paper_scene("warehouse") == "warehouse" and paper.paper_scene("greenhouse") is None
    assert paper.paper_rows("house", "extreme") == []


def test_csv_and_latex(tmp_path: Path) -> None:
    hostile = 'a_%&<b>"$'
    request = write_folder(tmp_path, missing=2, planners=["route", hostile], scenes=["house"], levels=["none", "major"], episodes=4)
    results = load_results(tmp_path)
    summary = summarize(results)
    write_csv(tmp_path / "r.csv", tables.episode_rows(results))
    with open(tmp_path / "r.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * 2 * request["episodes"] and sum(row["status"] == "pending" for row in rows) == 2
    latex = tables.write_latex(tmp_path / "t.tex", results, summary).read_text()
    assert r"a\_\%\&\textless{}b\textgreater{}" in latex and "2 of 4" in latex and r"\scriptsize [" in latex
    assert all(line.count("&") - line.count(r"\&") == 8 for line in latex.splitlines() if line.endswith(r"\\"))
    assert tables.latex_text("[a]") == "{[}a{]}"  # "\\ [" would read as an optional argument
