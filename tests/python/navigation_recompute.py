"""Recomputes the figures of a navigation benchmark from its episodes, independently of gloam.navigation.

    python3 navigation_recompute.py FOLDER
    ./gloam python tests/python/navigation_recompute.py FOLDER --logs

compares them with FOLDER/cells.csv, FOLDER/paired_tests.csv and the page, and ends with status 1 if they differ. It shares
no code with the package and needs only Python's library, so that an error in one of the two shows as a difference. With
--logs, the episodes are measured again from their logs (navigation_replay.py), otherwise read from episode.json.
"""

import csv
import json
import math
from pathlib import Path

import navigation_page

DRAWS = 2000  # bootstrap resamples: fewer than the package's, hence the wide tolerance of intervals


def cells(folder, read=lambda values, log: values):
    """{(planner, scene, level): {metric: value or (value, low, high)}} from the raw files. read(values, log): values of an
    episode from those of its episode.json and its log."""
    with open(f"{folder}/request.json", encoding="utf-8") as file:
        request = json.load(file)
    episodes = {}
    for planner in request["planners"]:
        for scene in request["scenes"]:
            for level in request["levels"]:
                episodes[planner, scene, level] = _episodes(f"{folder}/episodes/{planner}/{scene}/{level}", request["episodes"], read)
    return request, episodes, {name: _cell(group) for name, group in episodes.items()}


def _episodes(folder, count, read):
    found = {}
    for home in (Path(folder) / f"{number:04d}" for number in range(count)):
        if (home / "episode.json").is_file():
            found[int(home.name)] = read(json.loads((home / "episode.json").read_text(encoding="utf-8")), home / "run.mcap")
    return found


def sc(episode):
    return 1 / (1 + episode["collisions"]) if episode["outcome"] == "success" else 0.0


def spl(episode):
    if episode["outcome"] != "success":
        return 0.0
    longest = max(episode["shortest"], episode["path_length"])
    return 1.0 if episode["shortest"] == 0 else episode["shortest"] / longest


def _cell(group):
    rows = list(group.values())
    good = [row for row in rows if row["outcome"] == "success"]
    figures = {
        "finished": len(rows),
        "successes": len(good),
        "success": wilson(len(good), len(rows)),
        "sc": mean_with_interval([sc(row) for row in rows]),
        "spl": mean_with_interval([spl(row) for row in rows]),
        "collisions": mean_with_interval([row["collisions"] for row in rows]),
        "time": mean_with_interval([row["time"] for row in good]),
        "distance": mean_with_interval([row["final_distance"] for row in rows]),
        "wall": mean([row["wall_seconds"] for row in rows]),
        "cpu": mean([row["cpu_seconds"] for row in rows]),
        "visibility_mean": mean([row["visibility_mean"] for row in rows if row["visibility_mean"] is not None]),
    }
    plans = math.fsum(row["plans"] for row in rows)
    for name in ("late", "invalid"):
        figures[name] = math.fsum(row[name] for row in rows) / plans if plans else None
    return figures


def mean(values):
    return math.fsum(values) / len(values) if values else None


def wilson(good, count):
    """Roots of (rate − q)² = z² q (1 − q) / count, by bisection: another way than the closed form."""
    if count == 0:
        return None, None, None
    z, rate = 1.959963984540054, good / count

    def root(low, high):
        def outside(q):
            return (rate - q) ** 2 - z * z * q * (1 - q) / count > 0

        first = outside(low)
        for _ in range(200):
            middle = (low + high) / 2
            low, high = (middle, high) if outside(middle) == first else (low, middle)
        return (low + high) / 2

    return rate, 0.0 if good == 0 else root(0.0, rate), 1.0 if good == count else root(rate, 1.0)


def mean_with_interval(values):
    if len(values) < 2:
        return (values[0], None, None) if values else (None, None, None)
    state, means, n = 88172645463325252, [], len(values)
    for _ in range(DRAWS):
        total = 0.0
        for _ in range(n):  # xorshift64 (Marsaglia 2003)
            state ^= (state << 13) & 0xFFFFFFFFFFFFFFFF
            state ^= state >> 7
            state ^= (state << 17) & 0xFFFFFFFFFFFFFFFF
            total += values[(state >> 11) % n]
        means.append(total / n)
    means.sort()
    return mean(values), quantile(means, 0.025), quantile(means, 0.975)


def quantile(ordered, q):
    place = q * (len(ordered) - 1)
    low = int(place)
    return ordered[low] + (place - low) * (ordered[min(low + 1, len(ordered) - 1)] - ordered[low])


def standard_error(values):
    center = mean(values)
    return math.sqrt(math.fsum((value - center) ** 2 for value in values)) / len(values)


def paired(request, episodes):
    """{(kind, scene, common, first, second): (pairs, first only, second only, p of success, SC difference, p of SC or None)}."""
    tests = {}
    levels, planners = request["levels"], request["planners"]
    for scene in request["scenes"]:
        for planner in planners:
            for i in range(len(levels)):
                for k in range(i + 1, len(levels)):
                    tests["levels", scene, planner, levels[i], levels[k]] = _pair(
                        episodes[planner, scene, levels[i]], episodes[planner, scene, levels[k]]
                    )
        for level in levels:
            for i in range(len(planners)):
                for k in range(i + 1, len(planners)):
                    tests["planners", scene, level, planners[i], planners[k]] = _pair(
                        episodes[planners[i], scene, level], episodes[planners[k], scene, level]
                    )
    return tests


def _pair(first, second):
    numbers = [number for number in first if number in second]
    if not numbers:
        return 0, 0, 0, None, None, None
    lost = sum(first[n]["success"] and not second[n]["success"] for n in numbers)
    won = sum(second[n]["success"] and not first[n]["success"] for n in numbers)
    tail = math.fsum(math.comb(lost + won, k) * 0.5 ** (lost + won) for k in range(min(lost, won) + 1))
    differences = [sc(second[n]) - sc(first[n]) for n in numbers]
    return len(numbers), lost, won, min(1.0, 2 * tail), mean(differences), flips(differences)


def flips(differences):
    """Exact p-value from the distribution of the sum over all signs, in integers: SC has the unit 1 / lcm(1 … 40)."""
    unit = math.lcm(*range(1, 41))
    whole = [round(difference * unit) for difference in differences if difference]
    sums = {0: 1}
    for value in whole:
        following = {}
        for total, count in sums.items():
            for signed in (total + value, total - value):
                following[signed] = following.get(signed, 0) + count
        sums = following
    # A float has fewer digits than the unit; sums of the same fractions therefore differ by a little.
    least = abs(sum(whole)) - unit * 1e-9
    return sum(count for total, count in sums.items() if abs(total) >= least) / 2 ** len(whole)


def holm(values):
    """Step-down adjustment by its definition: the largest (m − j + 1) p_(j) over the ranks j up to the value's own."""
    order = sorted(values)
    return [min(1.0, max((len(order) - j) * order[j] for j in range(len(order)) if order[j] <= value)) for value in values]


def differences(folder, computed=None):
    """Sentences about figures of the package's tables that differ from the recomputed ones; empty if all agree.

    computed: the result of cells() of the same episodes, if it is known already.
    """
    request, episodes, figures = computed or cells(folder)
    figures, wrong = dict(figures), []
    with open(f"{folder}/cells.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            name = row["planner"], row["scene"], row["level"]
            wrong += [f"{name} {problem}" for problem in _compare_cell(row, figures.pop(name), list(episodes[name].values()))]
    wrong += [f"cells.csv lacks {name}" for name in figures]
    return wrong + _compare_tests(folder, paired(request, episodes))


def _compare_cell(row, figures, group):
    good = [e for e in group if e["outcome"] == "success"]
    values = {"sc": [sc(e) for e in group], "spl": [spl(e) for e in group], "collisions": [e["collisions"] for e in group],
              "time": [e["time"] for e in good], "distance": [e["final_distance"] for e in group]}
    wrong = []
    for metric, figure in figures.items():
        triple = figure if isinstance(figure, tuple) else (figure,)
        error = standard_error(values[metric]) if len(values.get(metric, [])) > 1 else 0.0
        for column, number in zip((metric, f"{metric}_low", f"{metric}_high"), triple):
            tolerance = 0.35 * error if column != metric else 0.0
            if not near(row[column], number, tolerance):
                wrong.append(f"{column}: {row[column] or 'empty'} in cells.csv, {number} recomputed")
    return wrong


def _compare_tests(folder, tests):
    wrong, rows = [], {}
    with open(f"{folder}/paired_tests.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            rows.setdefault(row["kind"], []).append(row)
    for kind in rows:
        listed = [(row, tests.pop((kind, row["scene"], row["common"], row["first"], row["second"]))) for row in rows[kind]]
        for row, (pairs, lost, won, success_p, change, sc_p) in listed:
            for column, number in (("pairs", pairs), ("first_only", lost), ("second_only", won), ("success_p", success_p),
                                   ("sc_difference", change), ("sc_p", sc_p)):
                # Beyond 16 different pairs the package draws 100,000 assignments: standard error sqrt(p / 100,000).
                tolerance = 5 * math.sqrt(sc_p / 1e5) + 2e-5 if column == "sc_p" and sc_p is not None and pairs > 16 else 0.0
                if not near(row[column], number, tolerance):
                    wrong.append(f"{row}: {column} is {number} recomputed")
        known = [row for row, test in listed if test[0]]
        adjusted = holm([float(row[column]) for row in known for column in ("success_p", "sc_p")])
        for i, row in enumerate(known):
            for column, number in (("success_holm", adjusted[2 * i]), ("sc_holm", adjusted[2 * i + 1])):
                if not near(row[column], number, 0.0):
                    wrong.append(f"{row}: {column} is {number} recomputed")
    return wrong + [f"paired_tests.csv lacks {name}" for name in tests]


def near(text, number, tolerance):
    if text == "" or number is None:
        return text == "" and number is None
    return abs(float(text) - number) <= tolerance + 1e-9 * max(1.0, abs(number))


def main(arguments):
    read = {}
    if "--logs" in arguments:
        from navigation_replay import measured

        read = {"read": measured}
    computed = cells(arguments[1], **read)
    wrong = differences(arguments[1], computed) + navigation_page.differences(Path(arguments[1], "report.html").read_text(), computed[2])
    print("\n".join(wrong) or "all figures agree")
    return 1 if wrong else 0


if __name__ == "__main__":
    import sys

    sys.exit(main(sys.argv))
