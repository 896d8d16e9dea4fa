"""Table of Experiment 1 (visual navigation) of a paper, as data for comparison."""

from __future__ import annotations

import re
from dataclasses import dataclass

CITATION = (
    "Jonathan Embley-Riches, Jianwei Liu, Simon Julier, Dimitrios Kanoulas: Unreal Robotics Lab: A High-Fidelity "
    "Robotics Simulator with Advanced Physics and Rendering. arXiv:2504.14135, Experiment 1."
)
RUNS = 5  # per cell


@dataclass(frozen=True)
class PaperRow:
    """One row as printed. success: rate over 5 runs; collisions: mean per run; time: [s], 0 as printed for failures, and
    also in two rows with successes; distance: to the goal at the end [m]; sc: success weighted by collisions."""

    scene: str
    level: str
    planner: str
    success: float
    collisions: float
    time: float
    distance: float
    sc: float

    @property
    def successes(self) -> int:
        """Successful runs of the 5."""
        return round(self.success * RUNS)


TABLE = (
    PaperRow("house", "none", "GNM", 1.0, 1.8, 147.86, 1.99, 0.3667),
    PaperRow("house", "none", "ViNT", 1.0, 0.8, 141.35, 2.00, 0.7333),
    PaperRow("house", "minor", "GNM", 1.0, 1.2, 71.59, 1.99, 0.5333),
    PaperRow("house", "minor", "ViNT", 0.4, 2.8, 0.0, 4.75, 0.09),
    PaperRow("house", "major", "GNM", 0.2, 13.0, 0.0, 7.01, 0.0154),
    PaperRow("house", "major", "ViNT", 0.0, 9.2, 0.0, 8.41, 0.0),
    PaperRow("warehouse", "none", "GNM", 0.8, 3.4, 102.86, 2.53, 0.1889),
    PaperRow("warehouse", "none", "ViNT", 0.8, 4.4, 90.14, 2.59, 0.3667),
    PaperRow("warehouse", "minor", "GNM", 0.4, 4.0, 107.62, 4.69, 0.1067),
    PaperRow("warehouse", "minor", "ViNT", 0.2, 6.6, 54.91, 6.61, 0.0250),
    PaperRow("warehouse", "major", "GNM", 0.0, 12.8, 0.0, 8.33, 0.0),
    PaperRow("warehouse", "major", "ViNT", 0.0, 6.4, 0.0, 7.96, 0.0),
)

DIFFERENCES = (
    ("Runs", "The paper averages 5 runs per cell and gives no intervals. The Wilson intervals beside its success rates "
             "are computed here from 5 runs: 5 of 5 successes are compatible with a rate of 0.57. Our intervals follow "
             "from the number of episodes in each cell."),
    ("Time to goal", "The paper prints 0 s in cells without a success, and also in two cells with successes (GNM, house, "
                     "major; ViNT, house, minor). A time of 0 looks like the best. We average successes only, give their "
                     "number, and print – if there is none."),
    ("Goal", "The paper does not state the distance at which its goal counts as reached; in cells in which all runs succeed, "
             "the mean final distance is 2 m. Ours counts as reached within 1 m."),
    ("Levels", "The paper's levels were classified by human judgment. Ours are fixed settings of the scene, and the page "
               "gives the visibility in metres that the robot had."),
    ("Robot", "The paper drives a Unitree Go1 with the walking controller Walk-These-Ways. Another robot or controller "
              "sways the camera differently, collides differently and has another speed."),
    ("Topological maps", "The paper uses the simplified topological maps of the planners' repository without tuning and "
                         "names this as a possible limit of their performance. Maps, start and goal differ from ours."),
    ("Scenes", "Only the names agree. Rooms, obstacles, distances, time limits and the renderer differ, so compare how "
               "results change with the level, not their absolute values."),
)


def paper_scene(scene: str) -> str | None:
    """The scene of the paper whose name is a word of this name ("house_small" → "house"), or None."""
    words = set(re.split(r"[^a-z]+", scene.lower()))
    return next((name for name in ("warehouse", "house") if name in words), None)


def paper_rows(scene: str, level: str) -> list[PaperRow]:
    """Rows of the paper for one of our scenes and a level; empty if the paper has none."""
    wanted = paper_scene(scene)
    return [row for row in TABLE if row.scene == wanted and row.level == level]
