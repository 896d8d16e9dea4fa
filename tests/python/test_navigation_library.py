"""Planners in shared libraries: built here with g++, as their users build them."""

from __future__ import annotations

import math
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import gloam
import numpy as np
import pytest
from gloam.envs.assets import asset_folder
from gloam.navigation import Arrived, Driver, MapSource, Node, Observation, Rig, Spacing, Task, TopologicalMap, Velocity, Waypoints
from gloam.navigation.planners import library
from gloam.navigation.planners.library import LibraryPlanner
from gloam.navigation.scene import drive
from navigation_scene import arena

ROOT = Path(__file__).resolve().parents[2]
STEER = ROOT / "examples" / "planner_library" / "steer.cc"
GOAL = (0.2, -0.4)

pytestmark = pytest.mark.skipif(shutil.which("g++") is None, reason="needs g++")

Build = Callable[..., Path]


@pytest.fixture(scope="module")
def build(tmp_path_factory: pytest.TempPathFactory) -> Build:
    """build(source, *flags): the library of a C++ source, or of C with -xc."""

    def make(source: str, *flags: str) -> Path:
        folder = tmp_path_factory.mktemp("library")
        (folder / "planner.cc").write_text(source)
        language = [] if "-xc" in flags else ["-std=c++17"]
        command = ["g++", *flags, *language, "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", f"-I{ROOT}/include"]
        subprocess.run([*command, str(folder / "planner.cc"), "-o", str(folder / "planner.so")], check=True, timeout=120)
        return folder / "planner.so"

    return make


HEAD = """
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include "gloam/planner/plugin.h"
"""
# Repeats its inputs as waypoints; its kind of answer is the seed of the task.
ECHO = HEAD + """
class Planner final : public gloam::PlannerPlugin {
 public:
  static constexpr GloamPlannerInfo kInfo = {5, 0.25, NEEDS, 4, 3};
  void reset(const GloamPlannerTask& task) override {
    answer_ = {static_cast<int32_t>(task.seed), 12, 4, 1, {1, 2, 3}, {}, {}};
    set(0, task.goal[0], task.goal[1], task.has_goal, task.goal_radius);
    set(1, task.top_speed, task.map_size, task.robot[0], 0);
    for (int i = 0; i < task.map_size; ++i) answer_.waypoints[1][3] += sum(task.map[i]);
  }
  void plan(const GloamPlannerObservation& in, GloamPlannerAnswer* answer) override {
    set(2, in.time, in.pose[0], in.pose[1], in.pose[2]);
    set(3, in.velocity[0], in.velocity[1], in.velocity[2], 0);
    set(4, in.image.width, in.image.height, sum(in.image), in.image.pixels ? in.image.pixels[1] : -1);
    set(5, in.depth_width, in.depth_height, in.depth ? in.depth[11] : -1, in.scan_size);
    for (int64_t i = 0; i < 3 * in.scan_size; ++i) answer_.waypoints[6][i % 3] += in.scan[i];
    *answer = answer_;
  }

 private:
  static double sum(const GloamPlannerImage& image) {
    double total = 0;
    for (int i = 0; i < 3 * image.width * image.height; ++i) total += image.pixels[i];
    return total;
  }
  void set(int row, double a, double b, double c, double d) {
    double* p = answer_.waypoints[row];
    p[0] = a, p[1] = b, p[2] = c, p[3] = d;
  }
  GloamPlannerAnswer answer_ = {};
};
GLOAM_PLANNER(Planner)
"""
# A planner of the same name, whose answers show the case that is given in place of the seed.
FAULTY = HEAD + """
class Planner final : public gloam::PlannerPlugin {
 public:
  static constexpr GloamPlannerInfo kInfo = {10, 0, 0, 0, 0};
  Planner() {
    if (std::getenv("NO_PLANNER")) throw std::runtime_error("no licence");
  }
  void reset(const GloamPlannerTask& task) override {
    if (task.seed == 99) throw std::runtime_error("no way: \\xe2\\x88\\x85");
    seed_ = task.seed;
  }
  void plan(const GloamPlannerObservation&, GloamPlannerAnswer* answer) override {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    answer->kind = GLOAM_PLANNER_VELOCITY;
    switch (seed_) {
      case 0: throw std::runtime_error(std::string(1000, 'x'));
      case 1: throw 42;
      case 2: throw std::runtime_error("");
      case 3: answer->velocity[1] = nan; return;
      case 4: answer->kind = 7; return;
      case 5: answer->kind = 0; return;
      case 6: *answer = {GLOAM_PLANNER_WAYPOINTS, 65, 2, 0, {}, {}, {}}; return;
      case 7: *answer = {GLOAM_PLANNER_WAYPOINTS, 3, 3, 0, {}, {}, {}}; return;
      case 8: *answer = {GLOAM_PLANNER_WAYPOINTS, 3, 2, -1, {}, {}, {}}; return;
      case 9: *answer = {GLOAM_PLANNER_WAYPOINTS, -2147483647 - 1, 2, 0, {}, {}, {}}; return;
      case 10: for (char& c : answer->error) c = 'y'; return;
      default: return;
    }
  }
  uint64_t seed_ = 0;
};
GLOAM_PLANNER(Planner)
"""


@pytest.fixture(scope="module")
def faulty(build: Build) -> Path:
    return build(FAULTY)


def test_structures_are_those_of_the_header(tmp_path: Path) -> None:
    mirrored = {
        "GloamPlannerInfo": library.Info,
        "GloamPlannerImage": library.ImageView,
        "GloamPlannerTask": library.TaskView,
        "GloamPlannerObservation": library.ObservationView,
        "GloamPlannerAnswer": library.AnswerBuffer,
        "GloamPlannerApi": library.Api,
    }
    lines, expected = [], []
    for name, mirror in mirrored.items():
        lines.append(f'printf("%zu\\n", sizeof(struct {name}));')
        expected.append(library.ctypes.sizeof(mirror))
        for field in mirror._fields_:
            lines.append(f'printf("%zu\\n", offsetof(struct {name}, {field[0]}));')
            expected.append(getattr(mirror, field[0]).offset)
    for constant in ("ABI", "MOST_WAYPOINTS", "ERROR_SIZE"):
        lines.append(f'printf("%d\\n", GLOAM_PLANNER_{constant});')
        expected.append(getattr(library, constant))
    text = "#include <stddef.h>\n#include <stdio.h>\n#include \"gloam/planner/abi.h\"\nint main(void) {" + "\n".join(lines) + "}"
    (tmp_path / "sizes.c").write_text(text)
    strict = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wstrict-prototypes", "-Werror"]
    subprocess.run(["gcc", *strict, f"-I{ROOT}/include", "sizes.c", "-o", "sizes"], cwd=tmp_path, check=True)
    out = subprocess.run([tmp_path / "sizes"], capture_output=True, text=True, check=True).stdout
    assert [int(line) for line in out.split()] == expected


def test_inputs_arrive_and_answers_return(build: Build) -> None:
    planner = LibraryPlanner(build(ECHO, "-DNEEDS=15"))
    assert planner.needs == {"image", "depth", "scan"} and planner.uses_map
    assert (planner.rate, planner.latency, planner.image_size) == (5, 0.25, (4, 3))
    nodes = [Node(np.full((2, 5, 3), k, np.uint8), (0, 0, 0), float(k)) for k in (1, 2)]
    map_ = TopologicalMap(nodes, MapSource("s", "0" * 64, "c"), Spacing("time", 1.0))
    planner.reset(Task("go", seed=2, goal=(1.5, -2.5), map=map_, top_speed=0.7, radius=0.3))
    image = np.arange(72, dtype=np.uint8).reshape(3, 4, 6)[:, :, ::2]  # not contiguous
    depth = np.arange(12, dtype=np.float64).reshape(3, 4)  # not float32
    scan = np.array([[1, 2, 3], [0.5, 0.5, 0.5]], np.float32)
    answer = planner.plan(Observation(9.5, (1, 2, 3), (4, 5, 6), image, depth.astype(np.float32), scan))
    assert isinstance(answer, Waypoints) and answer.chosen == 1
    assert answer.points.tolist()[:7] == [
        [1.5, -2.5, 1, 0.3],
        [0.7, 2, ord("g"), 90],
        [9.5, 1, 2, 3],
        [4, 5, 6, 0],
        [4, 3, float(image.sum()), 2],
        [4, 3, 11, 2],
        [1.5, 2.5, 3.5, 0],
    ]
    with pytest.raises(gloam.UsageError, match="needs a topological map"):
        planner.reset(Task("go"))
    planner.close()
    planner.close()
    with pytest.raises(gloam.ClosedError):
        planner.plan(Observation(0, (0, 0, 0), (0, 0, 0)))


def test_absent_inputs_are_null_and_other_kinds_of_answers(build: Build) -> None:
    planner = LibraryPlanner(build(ECHO, "-DNEEDS=0"))
    assert planner.needs == set() and not planner.uses_map
    nothing = Observation(0, (0, 0, 0), (0, 0, 0))
    for seed, expected in [(1, Velocity(1, 2, 3)), (3, Arrived())]:
        planner.reset(Task("go", seed=seed))
        assert planner.plan(nothing) == expected
    planner.reset(Task("go", seed=2))
    answer = planner.plan(nothing)
    assert isinstance(answer, Waypoints)
    assert answer.points[0].tolist() == [0, 0, 0, 0.5] and answer.points[4].tolist() == [0, 0, 0, -1]


def test_faults_of_answers_are_errors(faulty: Path) -> None:
    planner = LibraryPlanner(faulty)
    texts = {0: "x{255}$", 1: "unknown type", 2: "without a text", 4: "kind", 5: "kind", 6: "got 65 of 2", 7: "3 of 3", 9: "of 2", 10: "y{256}"}
    for seed, text in texts.items():
        planner.reset(Task("go", seed=seed))
        with pytest.raises(ValueError, match=text):
            planner.plan(Observation(0, (0, 0, 0), (0, 0, 0)))
    with pytest.raises(gloam.UsageError, match="rejects the task: no way: ∅"):
        planner.reset(Task("go", seed=99))
    planner.close()


@pytest.mark.parametrize("seed, text", [(0, "x" * 100), (3, "not finite"), (8, "contain the chosen one")])
def test_faults_are_counted_in_a_run(faulty: Path, seed: int, text: str) -> None:
    with gloam.Simulation(arena().compile()) as sim:
        driver = Driver(sim, Rig("go"), LibraryPlanner(faulty))
        driver.run(Task("go", seed=seed), 0.5)
        driver.close()
    assert driver.stats.invalid == driver.stats.plans == 5
    assert text in driver.stats.error and len(driver.stats.error) <= 300


def test_a_constructor_that_throws_makes_no_planner(faulty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_PLANNER", "1")
    with pytest.raises(gloam.UsageError, match="makes no planner: no licence"):
        LibraryPlanner(faulty)


def test_files_that_are_no_planners(tmp_path: Path, build: Build) -> None:
    (tmp_path / "text.so").write_text("not a library")
    table = '#include "gloam/planner/abi.h"\nconst struct GloamPlannerApi* gloam_planner(void) {{ static const struct GloamPlannerApi api = {}; return {}; }}'
    cases = [
        (tmp_path / "none.so", "cannot be loaded"),
        (tmp_path / "text.so", "cannot be loaded"),
        (build("int other() { return 0; }"), "does not define gloam_planner"),
        (build(table.format("{ 2 }", "&api"), "-xc", "-Wno-missing-field-initializers"), "version 2 .* Gloam has version 1"),
        (build(table.format("{ 1 }", "(void)api, (const struct GloamPlannerApi*)0"), "-xc", "-Wno-missing-field-initializers"), "returns no interface"),
        (build(table.format("{ 1 }", "&api"), "-xc", "-Wno-missing-field-initializers"), "lacks a function"),
        (build(ECHO, "-DNEEDS=32"), "inputs that do not exist: 0x20"),
        (build(ECHO.replace("NEEDS, 4, 3", "1, 0, -3")), "images have 1"),
    ]
    for file, message in cases:
        with pytest.raises(gloam.InputError, match=message):
            LibraryPlanner(file)


def test_a_rate_of_zero_is_rejected(build: Build) -> None:
    planner = LibraryPlanner(build(ECHO.replace("{5, 0.25, NEEDS", "{0, 0.25, 0")))
    with gloam.Simulation(arena().compile()) as sim, pytest.raises(gloam.UsageError, match="rate above 0"):
        Driver(sim, Rig("go"), planner)


def test_libraries_with_classes_of_one_name_stay_apart(faulty: Path, build: Build) -> None:
    first, second = LibraryPlanner(build(ECHO, "-DNEEDS=0")), LibraryPlanner(faulty)
    for planner in (first, second, LibraryPlanner(faulty)):
        planner.reset(Task("go", seed=1))
    nothing = Observation(0, (0, 0, 0), (0, 0, 0))
    assert first.plan(nothing) == Velocity(1, 2, 3)
    with pytest.raises(ValueError, match="unknown type"):
        second.plan(nothing)
    assert (first.rate, second.rate) == (5, 10)


def test_a_library_with_fast_arithmetic_leaves_that_of_gloam(build: Build) -> None:
    LibraryPlanner(build(ECHO, "-DNEEDS=0", "-O2", "-ffast-math"))
    smallest = np.array([2.0**-1022])
    assert (smallest / 4)[0] > 0, "subnormal numbers have become zero"


def test_the_example_reaches_its_goal_and_repeats(build: Build) -> None:
    file = build(STEER.read_text(), "-O2")
    world, hashes = arena().compile(), set()
    for _ in range(2):
        with gloam.Simulation(world) as sim:
            driver = Driver(sim, Rig("go", lidar="lidar"), LibraryPlanner(file))
            with pytest.raises(gloam.UsageError, match="needs the position of the goal"):
                driver.run(Task("go"), 1.0)
            driver.run(Task("go", goal=GOAL, radius=0.4), 15.0, lambda s: driver.has_arrived)  # noqa: B023
            driver.close()
            assert driver.has_arrived and driver.stats.invalid == 0
            assert math.dist(sim.robots["go"].pose.p[:2], GOAL) < 0.5
            hashes.add(sim.hash)
    assert len(hashes) == 1


def test_scenes_load_libraries_only_with_permission(build: Build) -> None:
    folder = build(STEER.read_text(), "-O2").parent
    shutil.copy(ROOT / "assets" / "environments" / "arena" / "arena.xml", folder)
    text = (STEER.parent / "arena.toml").read_text()
    text = text.replace("../../assets/environments/arena/", "").replace("../../assets/robots", str(asset_folder() / "robots"))
    (folder / "arena.toml").write_text(text.replace("steer.so", "planner.so"))
    with gloam.load(folder / "arena.toml") as sim:
        with pytest.raises(gloam.UsageError, match=r"loads the library .*planner\.so, which is not allowed"):
            drive(sim, 15.0)
        driver = drive(sim, 15.0, allow_programs=True)
        assert driver.has_arrived and driver.stats.invalid == 0
