"""What ./gloam bench measures: one function per subject, which yields rows. run.py prints and keeps them.

Whatever is compared runs in turns within the same minutes, so that a busy machine is busy for both.
"""
import json
import math
import os
import shutil
import statistics
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BIN = ROOT / "build" / os.environ.get("GLOAM_PRESET", "release") / "bin"
CACHE = ROOT / ".cache"
PEER_PACKAGES = ["libllvm19", "libegl1", "libgles2", "libgl1-mesa-dri", "mesa-vulkan-drivers"]

sys.path.insert(0, str(ROOT / "tests"))
import fetch_data  # noqa: E402
import view_rate  # noqa: E402


def say(text):
    print(f"gloam: {text}", file=sys.stderr, flush=True)


def run(*command, **env):
    """Standard output of a program that must succeed."""
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, env={**os.environ, **env})
    if result.returncode != 0:
        words = (result.stderr or result.stdout).strip().splitlines() or [f"exit status {result.returncode}"]
        raise RuntimeError(f"{Path(str(command[0])).name}: {words[-1]}")
    return result.stdout


def run_json(*command, **env):
    return json.loads(run(*command, **env).strip().splitlines()[-1])


def at_least(name, value, bar, note):
    return {"name": name, "value": float(f"{value:.6g}"), "bar": bar, "better": "higher", "met": value >= bar, "note": note}


def at_most(name, value, bar, note):
    return {"name": name, "value": float(f"{value:.6g}"), "bar": bar, "better": "lower", "met": value <= bar, "note": note}


def robot(name):
    """A third-party model of the test data, fetched once."""
    data = Path(os.environ.get("GLOAM_TEST_DATA") or fetch_data.default_folder())
    if not (data / "mjlab").exists():
        say("fetching the robots to measure with")
        run(sys.executable, ROOT / "tests" / "fetch_data.py", data)
    found = sorted((data / "mjlab").glob(f"**/{name}.xml"))
    if not found:
        raise RuntimeError(f"{name}.xml is not in {data}: remove that folder, it is fetched again")
    return found[0]


def peer_python():
    python, wanted = CACHE / "bench_venv" / "bin" / "python", (ROOT / "bench" / "requirements.txt").read_text()
    installed = CACHE / "bench_venv" / "requirements.txt"
    if not installed.exists() or installed.read_text() != wanted:
        say("installing the peers (MuJoCo's renderers, Mitsuba; 300 MB) into .cache/bench_venv")
        missing = [p for p in PEER_PACKAGES if subprocess.run(["dpkg", "-s", p], capture_output=True).returncode != 0]
        if missing:
            run(*(["sudo"] if os.geteuid() else []), "apt-get", "install", "-y", "--no-install-recommends", *missing)
        fresh = CACHE / "bench_venv.new"  # complete or absent, also after Ctrl-C
        shutil.rmtree(fresh, ignore_errors=True)
        run(sys.executable, "-m", "venv", fresh)
        run(fresh / "bin" / "python", "-m", "pip", "install", "-q", "-r", ROOT / "bench" / "requirements.txt")
        (fresh / "requirements.txt").write_text(wanted)
        shutil.rmtree(CACHE / "bench_venv", ignore_errors=True)
        fresh.rename(CACHE / "bench_venv")
    return python


def sim_step_rate(quick):
    """steps through the Simulator against a bare mj_step loop"""
    data = run_json(BIN / "bench_sim_step_rate", robot("go1"), "--json", "--pairs", 10 if quick else 60)
    yield at_least("sim thread's step rate / bare mj_step, lower 95 % bound", data["lower_95"], 0.97,
                   f"median {data['median_ratio']:.3f} of {data['pairs']} pairs; {data['bare_us']:.1f} µs a bare step")


def sim_beside_cameras(quick):
    """steps while two cameras render, against bare steps while the same cameras render in another process"""
    data = run_json(BIN / "bench_sim_beside_cameras", robot("go1"), "--json", "--pairs", 4 if quick else 120)
    yield at_least("the same while two cameras render, lower 95 % bound", data["lower_95"], 0.9,
                   f"median {data['median_ratio']:.3f} of {data['pairs']} pairs; rendering per stepping, in CPU time: "
                   f"{data['rendering_beside_simulator']:.1f} ours, {data['rendering_beside_bare']:.1f} bare")


def path_tier(quick):
    """paths per second against Mitsuba 3.9 (llvm_ad_rgb): same meshes, materials, light, depth"""
    folder = CACHE / "bench_room"
    folder.mkdir(parents=True, exist_ok=True)
    library = next(Path("/usr/lib").glob("*/libLLVM*19*.so*"), None) if peer_python() else None
    if library is None:
        raise RuntimeError("libLLVM 19 is missing: apt-get install libllvm19")

    def against_mitsuba(*options):
        """Median ratio, our figures."""
        ours, theirs = [], []
        for _ in range(1 if quick else 4):
            ours.append(run_json(BIN / "bench_path_rate", "--plain", "--spp", 4, "--runs", 3, "--json", "--export", folder, *options))
            theirs.append(run_json(peer_python(), ROOT / "bench" / "peers" / "mitsuba_room.py", folder, "--spp", 4, "--runs", 3,
                                   DRJIT_LIBLLVM_PATH=str(library)))
        if abs(ours[0]["mean"] / theirs[0]["mean"] - 1) > 0.02:
            raise RuntimeError(f"the two pictures differ: mean radiance {ours[0]['mean']} against {theirs[0]['mean']}")
        return statistics.median(a["mpaths_per_s"] / b["mpaths_per_s"] for a, b in zip(ours, theirs)), ours

    ratio, ours = against_mitsuba()
    meshes, _ = against_mitsuba("--meshes")
    rate = statistics.median(a["mpaths_per_s"] for a in ours)
    share = statistics.median(a["mpaths_per_s"] / a["bare_mpaths_per_s"] for a in ours)
    yield at_least("path tier: paths/s / Mitsuba 3.9 llvm_ad_rgb", ratio, 1.0,
                   f"{meshes:.2f} with every box as a mesh; {rate:.2f} Mpaths/s of CPU time; {ours[0]['rays_per_path']:.2f} rays/path; "
                   f"{share:.0%} of the bare Embree loop (aim 65 %)")


def equal_error(quick):
    """time to an equal error against Mitsuba 3.9 (llvm_ad_rgb) in three rooms: same lobes, lights, size, depth"""
    library = next(Path("/usr/lib").glob("*/libLLVM*19*.so*"), None) if peer_python() else None
    if library is None:
        raise RuntimeError("libLLVM 19 is missing: apt-get install libllvm19")
    size = ["--spp", "4,16", "--pictures", 4, "--samplers", "independent"] if quick else []
    text = run(peer_python(), ROOT / "bench" / "mitsuba" / "equal_error.py", CACHE / "bench_rooms", BIN / "bench_path_blocks", *size,
               DRJIT_LIBLLVM_PATH=str(library))
    for room in map(json.loads, text.strip().splitlines()):
        ratios = room["ratio"].values()
        yield at_least(f"Mitsuba's CPU time / ours at equal error: {room['room']}", statistics.geometric_mean(ratios), 2.0,
                       f"{', '.join(f'{ratio:.2f} at {spp}' for spp, ratio in room['ratio'].items())} samples; Mitsuba's best: {room['best']}; "
                       f"slopes {room['slopes'][0]:.2f}, {room['slopes'][1]:.2f}; the light {'agrees' if room['agrees'] else 'DIFFERS'}: "
                       f"{room['agreement']}")


def boxes_scene():
    """Go1, a floor and 20 boxes under a shadowing light, beside a copy of the robot's files."""
    folder = CACHE / "bench_boxes"
    source = robot("go1").parent
    shutil.copytree(source, folder, dirs_exist_ok=True)
    boxes = "".join(f'<body pos="{-1.5 + 0.75 * (i % 5):g} {-1.5 + i // 5:g} 0.1"><freejoint/>'
                    f'<geom type="box" size=".1 .1 .1" mass="1" rgba=".{3 + i % 6} .4 .5 1"/></body>' for i in range(20))
    scene = folder / "bench_boxes.xml"
    scene.write_text('<mujoco><include file="go1.xml"/><worldbody>'
                     '<light type="spot" pos="1 1 3" dir="-.3 -.3 -1" castshadow="true"/><geom type="plane" size="5 5 .1"/>'
                     f'{boxes}<camera name="bench" pos="1.2 -1.2 .8" xyaxes=".7 .7 0 -.3 .3 .9"/></worldbody></mujoco>')
    return scene


def milliseconds(*command):
    """[wall, CPU] of the last line "WALL ms CPU ms"."""
    words = run(*command).strip().splitlines()[-1].split()
    return [float(words[0]), float(words[2])]


def direct_tier(quick):
    """one 640x480 picture with shadows against MuJoCo's own renderers on the same model"""
    scene = boxes_scene()
    pictures = CACHE / "bench_pictures"
    pictures.mkdir(exist_ok=True)
    commands = {"ours": [BIN / "bench_direct_rate", scene, "bench", "--frames", 20, "--picture", pictures / "direct_ours.png"]}
    for peer in ("classic", "filament"):
        commands[peer] = [peer_python(), ROOT / "bench" / "peers" / "mujoco_render.py", scene, "bench", peer, 640, 480, 8,
                          pictures / f"direct_{peer}.png"]
    times = {who: [] for who in commands}
    for _ in range(1 if quick else 5):
        for who, command in commands.items():
            times[who].append(milliseconds(*command))
    for peer, label in (("classic", "MuJoCo classic (EGL, llvmpipe)"), ("filament", "MuJoCo Filament (lavapipe)")):
        wall, cpu = (statistics.median(a[k] / b[k] for a, b in zip(times[peer], times["ours"])) for k in (0, 1))
        theirs, own = (statistics.median(t[0] for t in times[who]) for who in (peer, "ours"))
        yield at_least(f"direct tier: {label} / ours", wall, 3.0, f"{theirs:.0f} ms against {own:.0f} ms; in CPU time {cpu:.1f}")


def direct_places(quick):
    """the direct tier at 640x360 where there are many lamps, one sample, against the path tier's"""
    scenes = CACHE / "bench_places"
    scenes.mkdir(parents=True, exist_ok=True)
    camera = '[[camera]]\nname = "bench"\nposition = [0, 0, 1.6]\nlook_at = [2, 1, 1.2]\n'
    places = {"demo": (ROOT / "examples" / "demo.toml", "chase")}
    for place in ("house", "warehouse"):
        scene = scenes / f"{place}.toml"
        scene.write_text(f"[environment.{place}]\nseed = 4\n{camera}")
        places[place] = (scene, "bench")
    for place, (scene, name) in places.items():
        wall = {}
        for tier in ("direct", "path"):
            wall[tier] = milliseconds(BIN / "bench_direct_rate", scene, name, "--size", "640x360", "--tier", tier,
                                      "--frames", 3 if quick else 9)[0] / 1e3
        yield at_most(f"direct tier in {place}: seconds a sample at 640x360", wall["direct"], 0.25,
                      f"wall; path tier {wall['path']:.2f} s, ratio {wall['direct'] / wall['path']:.2f}")


def view(quick):
    """the studio at 640x480: pictures a second of the demo while it runs, the first one in a generated house, and requests there"""
    demo = view_rate.watch(BIN / "gloam", ROOT / "examples" / "demo.toml", "free", 3 if quick else 8)
    yield at_least("page, demo: pictures a second while it runs", demo["rate"], 10,
                   f"{demo['width']} px wide; paused, {demo['still']} pictures of {demo['still_width']} px were added up")
    scene = CACHE / "bench_places" / "house_view.toml"
    scene.parent.mkdir(parents=True, exist_ok=True)
    scene.write_text("[environment.house]\nseed = 4\n")
    house = view_rate.watch(BIN / "gloam", scene, "free", 3 if quick else 8)
    yield at_most("page, house: seconds to the first picture", house["first"], 3, f"then {house['rate']:.1f} a second, {house['width']} px wide")
    yield at_most("page, house: seconds to the state that shows a request, 95 %", house["request"], 0.1, "while the simulation runs")


def truth(quick):
    """exact depth and segmentation 640x480 against MuJoCo's depth pass plus its segmentation pass"""
    scene = boxes_scene()
    ours = [BIN / "bench_direct_rate", scene, "bench", "--truth", "--frames", 20]
    theirs = [peer_python(), ROOT / "bench" / "peers" / "mujoco_render.py", scene, "bench", "truth", 640, 480, 8]
    pairs = [(milliseconds(*theirs), milliseconds(*ours)) for _ in range(1 if quick else 5)]
    wall, cpu = (statistics.median(a[k] / b[k] for a, b in pairs) for k in (0, 1))
    their, own = (statistics.median(pair[k][0] for pair in pairs) for k in (0, 1))
    yield at_least("depth + segmentation: MuJoCo classic's two passes (EGL) / ours", wall, 2.0,
                   f"wall, medians of turns: {their:.1f} ms against {own:.1f} ms; in CPU time {cpu:.1f}")


def seconds_until_ready(cache, *command):
    """[CPU, wall] from the start of a process to the moment that it says it is ready."""
    start = time.monotonic()
    cpu, ready = (float(word) for word in run(*command, GLOAM_CACHE=str(cache)).split())
    return [cpu, ready - start]


def load_time(quick):
    """fresh processes that load third-party models, against mj_loadXML"""
    names, ratios = ("go1", "g1", "yam"), {"physics": [], "render": [], "cached": []}
    for name in names:
        model, pairs = robot(name), {kind: [] for kind in ratios}
        with tempfile.TemporaryDirectory(prefix="gloam_bench_") as warm:
            run(BIN / "bench_load_time", model, "physics", GLOAM_CACHE=warm)
            for _ in range(2 if quick else 15):
                bare = seconds_until_ready(warm, BIN / "bench_bare_load", model)
                for kind in ratios:
                    with tempfile.TemporaryDirectory(prefix="gloam_bench_") as empty:
                        what, cache = ("physics", warm) if kind == "cached" else (kind, empty)
                        ours = seconds_until_ready(cache, BIN / "bench_load_time", model, what)
                    pairs[kind].append([a / b for a, b in zip(ours, bare)])
        for kind in ratios:
            ratios[kind].append([statistics.median(pair[k] for pair in pairs[kind]) for k in (0, 1)])
    for kind, what, bar in (("physics", "ready for physics", 1.15), ("render", "ready to render", 1.6),
                            ("cached", "ready for physics from our cache", 0.7)):
        each = ", ".join(f"{name} {cpu:.2f}" for name, (cpu, _) in zip(names, ratios[kind]))
        walls = ", ".join(f"{wall:.2f}" for _, wall in ratios[kind])
        yield at_most(f"{what} / mj_loadXML, slowest model", max(cpu for cpu, _ in ratios[kind]), bar,
                      f"CPU time: {each}; wall: {walls}")


def first_picture(quick):
    """the program's start to a written picture of the demo's room, warm"""
    command = [BIN / "gloam", "render", ROOT / "examples" / "demo.toml", "--camera", "chase", "--spp", 1, "--out",
               CACHE / "bench_pictures"]
    run(*command)
    walls, cpus = [], []
    for _ in range(2 if quick else 7):
        start, before = time.monotonic(), os.times()
        run(*command)
        after = os.times()
        walls.append(time.monotonic() - start)
        cpus.append(after.children_user + after.children_system - before.children_user - before.children_system)
    yield at_most("first picture after a warm start [s]", statistics.median(walls), 3.0,
                  f"wall; CPU time of all threads {statistics.median(cpus):.1f} s; 640x480, 1 sample a pixel, denoised")


def write_waves(path, side):
    """A binary PLY of 2 side² triangles with normals: a square metre of waves."""
    row = struct.Struct("<6f")
    with open(path, "wb") as out:
        out.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {(side + 1) ** 2}\n" +
                   "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz")) +
                   f"element face {2 * side * side}\nproperty list uchar int vertex_indices\nend_header\n").encode())
        waves = [(0.01 * math.sin(60 * i / side), 0.6 * math.cos(60 * i / side)) for i in range(side + 1)]
        for j, (h, hy) in enumerate(waves):
            out.write(b"".join(row.pack(i / side, j / side, h + g, -gx, -hy, 1) for i, (g, gx) in enumerate(waves)))
        face = struct.Struct("<BiiiBiii")
        for j in range(side):
            first = j * (side + 1)
            out.write(b"".join(face.pack(3, a, a + 1, a + side + 2, 3, a, a + side + 2, a + side + 1)
                               for a in range(first, first + side)))


def import_time(quick):
    """a scene with a scanned mesh of five million triangles: first start and second"""
    side = 500 if quick else 1600
    with tempfile.TemporaryDirectory(prefix="gloam_bench_") as folder:
        write_waves(Path(folder) / "waves.ply", side)
        scene = Path(folder) / "scene.toml"
        scene.write_text('[[visual]]\nname = "waves"\nfile = "waves.ply"\n')
        ratios, notes = [], []
        for _ in range(1 if quick else 3):
            shutil.rmtree(Path(folder) / "cache", ignore_errors=True)
            first, second = [seconds_until_ready(f"{folder}/cache", BIN / "bench_load_time", scene, "render") for _ in range(2)]
            ratios.append(second[0] / first[0])
            notes.append(f"{first[1]:.2f} and {second[1]:.2f}")
    yield at_most(f"second start / first, PLY of {2 * side * side / 1e6:.1f} M triangles", statistics.median(ratios), 0.9,
                  f"CPU time to the first ray; wall {', '.join(notes)} s")


def adaptive_sampling(quick):
    """--error against an even picture of as many samples"""
    lines = run(BIN / "bench_adaptive_error", "--json", "--error", 0.05, "--size", "64x48", "--seeds", 2 if quick else 4).strip().splitlines()
    scenes = [json.loads(line) for line in lines]
    each = ", ".join(f"{s['scene']} {s['gain']:.2f}" for s in scenes)
    yield at_least("--error: worth of a sample against even sampling, worst scene", min(s["gain"] for s in scenes), 0.5,
                   f"each: {each}; 0.05 asked for, reached {', '.join(format(s['reached'], '.3f') for s in scenes)}")


def interactive_error(*options):
    """The object that bench/interactive_error.py prints; its exit status also depends on the bars."""
    result = subprocess.run([peer_python(), ROOT / "bench" / "interactive_error.py", "--json", *map(str, options)], capture_output=True, text=True)
    lines = result.stdout.splitlines()
    if not lines:
        raise RuntimeError((result.stderr.strip().splitlines() or [f"interactive_error.py: exit status {result.returncode}"])[-1])
    return json.loads(lines[-1])


def interactive_tier(quick):
    """a picture of 640 x 480 of a furnished room with a moving robot of 418,000 triangles against a bare Embree loop that traces its primary
    and one shadow ray; how far five moving scenes are from the path tier"""
    data = run_json(BIN / "bench_path_rate", "--interactive", "--meshes", "--json", "--runs", 7 if quick else 25)
    yield at_most("interactive tier 640 x 480: CPU time / bare primary and shadow loop", data["cpu_over_bare"], 2.75,
                  f"medians of turns in one process, all threads: {data['cpu_ms']:.0f} ms CPU, {data['wall_ms']:.0f} ms wall; the bare loop "
                  f"{data['cpu_ms'] / data['cpu_over_bare']:.0f} ms CPU")
    error = interactive_error(*(["--quick"] if quick else []))
    each = "; ".join(f"{row['scene']} picture {row['picture']}: {row['FLIP mean']:.4f}, 95 % {row['FLIP 95 %']:.4f} (halves of the reference "
                     f"{row['halves']:.4f})" for row in error["rows"])
    yield at_most("interactive tier: mean LDR-FLIP against the path tier, worst scene", error["worst"]["FLIP mean"], 0.08, each)
    yield at_most("interactive tier: 95th percentile of LDR-FLIP, worst scene", error["worst"]["FLIP 95 %"], 0.25, "of the same pictures")


def truth_at_few_samples(quick):
    """mean light of denoised pictures of few samples, and of the interactive tier, against many samples in the examples"""
    names = os.environ.get("GLOAM_BENCH_SCENES", "house,office" if quick else "")
    every = sorted(p for p in (ROOT / "examples").glob("*.toml") if "[[camera]]" in p.read_text())
    scenes = [p for p in every if not names or p.stem in names.split(",")]
    if not scenes:
        raise RuntimeError(f"GLOAM_BENCH_SCENES: none of {names}; there are: {', '.join(p.stem for p in every)}")
    size = ["--spp", 32, "--seeds", 2] if quick else []
    found = [run_json(BIN / "bench_few_samples", scene, "--json", *size) for scene in scenes]

    def off(data, key):
        return max(abs(ratio - 1) for ratio in data[key]["ratio"])

    def note(data, key):
        ratios = "/".join(f"{r:.3f}" for r in data[key]["ratio"])
        own = f", {min(data[key]['kept'], key=lambda k: -abs(k - 1)):.3f} of its samples'" if "kept" in data[key] else ""
        return f"{data['scene']} {ratios} ± {max(data[key]['error']):.3f}{own}"

    for key, bar in (("path 4", 0.05), ("path 16", 0.05), ("interactive", 0.2)):
        worst = sorted(found, key=lambda data: -off(data, key))
        yield at_most(f"{key}: mean light against many samples, worst channel and scene", off(worst[0], key), bar,
                      "; ".join(note(data, key) for data in worst))
    still = {data["scene"]: data["still"] for data in found if data["scene"] in ("house", "warehouse", "office")}
    if still:
        yield at_most("still scene at 16 samples: deviation over frames [1/255]", max(still.values()), 2,
                      ", ".join(f"{name} {value:.2f}" for name, value in still.items()))


def lidar_scene(name, model):
    """Go1, a floor, four walls and 20 boxes; a LiDAR of 64 x 1024 beams 1.2 m from the robot, which it faces."""
    folder = CACHE / "bench_lidar"
    shutil.copytree(robot("go1").parent, folder, dirs_exist_ok=True)
    boxes = "".join(f'<geom type="box" size=".1 .1 .1" pos="{-1.5 + 0.75 * (i % 5):g} {-2.25 + 1.5 * (i // 5):g} 0.1"/>' for i in range(20))
    walls = "".join(f'<geom type="box" size="{size}" pos="{x} {y} 1.4"/>' for size, x, y in
                    (("3.1 .05 1.4", 0, 2.6), ("3.1 .05 1.4", 0, -2.6), (".05 2.6 1.4", 3.1, 0), (".05 2.6 1.4", -3.1, 0)))
    (folder / "room.xml").write_text(f'<mujoco><worldbody><geom type="plane" size="5 5 .1"/>{walls}{boxes}</worldbody></mujoco>')
    scene = folder / f"{name}.toml"
    scene.write_text(f'[environment]\nfile = "room.xml"\n[[robot]]\nname = "go1"\nfile = "go1.xml"\nposition = [0, 0, 0.05]\n'
                     f'[[lidar]]\nname = "lidar"\n{model}\nposition = [0.72, 0.96, 0.3]\norientation = [0.4472136, 0, 0, -0.8944272]\n'
                     'min_range = 0.05\nrange_at_10_percent = 0\n')
    return scene


def lidar(quick):
    """scans of 64 x 1024 beams 1.2 m from a moving robot against mj_multiRay with the same rays, one thread each"""
    looks = {"all around (OS1-64)": lidar_scene("around", 'preset = "OS1-64"\ncolumns = 1024'),
             "60 x 40 degrees towards it": lidar_scene("ahead", 'pattern = "raster"\nrows = 64\ncolumns = 1024\nrate = 10\nfield_of_view = [60, 40]')}
    ratios, notes = [], []
    for look, scene in looks.items():
        data = run_json(BIN / "bench_lidar_rate", scene, "--json", "--runs", 5 if quick else 21)
        if data["same"] < 0.97:
            raise RuntimeError(f"{look}: only {data['same']:.1%} of the ranges agree with mj_multiRay")
        ratios.append(data["ratio"])
        notes.append(f"{look}: {data['ratio']:.1f}, {data['ours_ms']:.1f} ms with motion and intensity against {data['multiray_ms']:.1f} ms, two threads "
                     f"{data['two_threads_ms']:.1f} ms wall, {data['same']:.1%} of the ranges agree, {data['on_robot']:.0%} hit the robot")
    yield at_least("LiDAR 64 x 1024 near Go1: mj_multiRay's CPU time / ours", min(ratios), 4.0, "; ".join(notes))


def environments(quick):
    """generated places: until they are ready to render, and how fast they step"""
    go1 = '[[robot]]\nname = "go1"\nfile = "go1/go1.xml"\n'
    house = "[environment.house]\nseed = 3\nrooms = 6\n"
    warehouse = "[environment.warehouse]\nseed = 2\nlength = 38\nwidth = 30\n"
    with tempfile.TemporaryDirectory(prefix="gloam_bench_") as folder:
        scene, warm = Path(folder) / "scene.toml", Path(folder) / "warm"
        shutil.copytree(robot("go1").parent, Path(folder) / "go1")  # a scene reads nothing outside its folder
        scene.write_text(house)
        command, cold, cached = (BIN / "bench_load_time", scene, "render"), [], []
        run(*command, GLOAM_CACHE=str(warm))
        for i in range(2 if quick else 7):
            cold.append(seconds_until_ready(Path(folder) / f"cold_{i}", *command)[1])
            cached.append(seconds_until_ready(warm, *command)[1])
        yield at_most("house of 6 rooms ready to render, cold [s]", statistics.median(cold), 5, "wall, generated and compiled")
        yield at_most("the same from our cache [s]", statistics.median(cached), 1, "wall")
        scene.write_text(house + go1)
        data = run_json(BIN / "bench_place_rate", scene, 2 if quick else 10, GLOAM_CACHE=str(warm))
        yield at_least("physics of the house with a Go1 / real time, one core", data["real_time"], 5,
                       f"{data['things']} things, {data['dofs']} degrees of freedom, {data['contacts']} contacts, {data['step_us']:.0f} µs a step")
        others = [("a warehouse of 1,000 props", warehouse, 1000), ("an office with a Go1", "[environment.office]\nseed = 1\n" + go1, 0),
                  ("open country with a Go1", "[environment.terrain]\nseed = 1\n" + go1, 0)]
        for what, text, things in others:
            scene.write_text(text)
            data = run_json(BIN / "bench_place_rate", scene, 2 if quick else 10, GLOAM_CACHE=str(warm))
            yield at_least(f"physics of {what} / real time, one core", data["real_time"] * (data["things"] >= things), 1,
                           f"{data['things']} things, {data['dofs']} degrees of freedom, {data['contacts']} contacts, {data['step_us']:.0f} µs a step")


def hfield(quick):
    """ground sampled from meshes into height fields"""
    samples = "1e6" if quick else "4e6"
    for triangles, layers in (("2e5", 1), ("2e6", 1), ("2e5", 2)):
        one, two = (run_json(BIN / "bench_height_field_rate", triangles, samples, str(threads), str(layers)) for threads in (1, 2))
        what = "from above" if layers == 1 else f"{layers} layers"
        yield at_least(f"ground of {two['triangles'] / 1e6:.1f} M triangles, {what}: M samples/s on 2 cores", two["rate"] / 1e6, 5,
                       f"{two['samples'] / 1e6:.0f} M samples in {two['seconds']:.2f} s wall, from the mesh to the heights; one thread {one['rate'] / 1e6:.1f} M/s")


def policy(quick):
    """networks of policies in the control loop"""
    data = run_json(BIN / "bench_policy_rate", "--json")
    yield at_most("a policy of three layers of 512, OpenVINO f32 on one thread: µs", data["median_us"], 50,
                  f"median of 10,000 runs; 99 % below {data['p99_us']:.0f} µs")


def gas(quick):
    """smoke and fire: steps of the solver"""
    data = run_json(BIN / "bench_gas_rate", "--steps", "10" if quick else "60", "--threads", "2", "--json")
    yield at_least("gas of 96 x 96 x 64 voxels, a fire among furniture: steps/s on 2 cores", data["steps_per_s"], 10,
                   f"steps of 0.1 s, {data['substeps_per_step']:.1f} substeps, {data['iterations_per_substep']:.1f} iterations of the pressure in each")
    yield at_most("the same: L2 norm of the divergence after / before, worst step", data["worst_divergence_ratio"], 1e-4, "something moves")


def effects(quick):
    """what the fire of examples/house_fire.toml costs, against the same scene without"""
    data = run_json(BIN / "bench_effects_cost", ROOT / "examples" / "house_fire.toml", "living", "--json", "--at", 10 if quick else 20,
                    "--blocks", 6 if quick else 20, "--pictures", 3 if quick else 8)
    yield at_most("CPU time of the stepping thread with a fire / without", data["step_ratio"], 1.1, f"medians; {data['step_us']:.0f} µs a step")
    yield at_least("house fire: simulated time / real time, gas at 10 Hz", data["real_time"], 1, "on 2 cores, without pictures")
    yield at_most("interactive tier 640 x 480 with a room full of smoke / without", data["picture_ratio"], 2,
                  f"wall, medians: {data['picture_ms']:.0f} ms, {data['clear_ms']:.0f} ms without")


def all_effects(quick):
    """what gas, weather, water and soil cost together, against the same scenes without any"""
    for scene, camera, where in (("all_effects", "garden", ""), ("house", "living", ", in a house")):
        data = run_json(BIN / "bench_effects_cost", ROOT / "bench" / "effects_scene" / f"{scene}.toml", camera, "--json", "--each",
                        "--at", 4, "--blocks", 6 if quick else 20, "--pictures", 0)
        yield at_most(f"CPU time of the stepping thread with all effects / without{where}", data["step_ratio"], 1.1,
                      f"medians; {data['step_us']:.0f} and {data['bare_us']:.0f} µs a step; alone: "
                      f"{', '.join(f'{name} {us:.0f}' for name, us in data['each_us'].items())} µs")


def log_rate(quick):
    """writing a log of pictures against plain writes and one fsync of the same bytes; time to a message in the middle of it"""
    megabytes = 100 if quick else 1000
    CACHE.mkdir(parents=True, exist_ok=True)
    data = run_json(BIN / "bench_log_rate", CACHE, "--json", "--megabytes", megabytes, "--pairs", 1 if quick else 3)
    yield at_least("log of incompressible messages: bytes per second / plain writes", data["ratio"], 0.7,
                   f"200 KiB each, {megabytes} MB, through the queue, with one fsync: {data['log_mb_s']:.0f} MB/s, plain {data['plain_mb_s']:.0f} MB/s")
    yield at_most("the same: open, seek, read a message, worst of 20 [ms]", data["seek_max_ms"], 100,
                  f"log not in memory; median {data['seek_median_ms']:.1f} ms")


def record_cost(quick):
    """a log of states, /tf and joints against bare steps; the same with four cameras and all other topics; verification"""
    for scene in ("house", "two_robots"):
        data = run_json(BIN / "bench_record_cost", ROOT / "examples" / f"{scene}.toml", CACHE, "--json", "--cameras", 0,
                        "--seconds", 10, "--pairs", 5 if quick else 15)
        yield at_most(f"CPU time that a log of states adds to the thread that steps, {scene}", data["overhead"], 0.02,
                      f"median of pairs; {data['logged_us']:.1f} µs a step, bare {data['bare_us']:.1f} µs; "
                      f"wall {data['logged_wall_us']:.1f} and {data['bare_wall_us']:.1f} µs")
    yield at_least("steps per second of a verification / of a bare run", data["verify_over_bare"], 0.9, f"{data['steps']} steps, {data['differing']} differ")
    data = run_json(BIN / "bench_record_cost", ROOT / "examples" / "house.toml", CACHE, "--json", "--pairs", 1)
    yield at_most("the same with four cameras 640x480 and all topics, house", data["overhead"], 0.02,
                  f"{data['logged_us']:.1f} µs a step, bare {data['bare_us']:.1f} µs; the thread waited for pictures "
                  f"{data['waits'][1]} times in {data['steps']} steps; {data['megabytes']:.0f} MB for a second")


def latency(quick):
    """from an instant to its message in another process, by bridge, stream and size: what the bridge adds, the renderer's share aside"""
    bars = {("zmq shm", "raw 640x480"): 0.3, ("zmq", "raw 640x480"): 1, ("ros2", "JPEG 640x480"): 5, ("ros2", "state 1 kHz"): 0.3,
            ("zmq", "state 1 kHz"): 1}
    lines = run(BIN / "bench_latency", "--seconds", 2 if quick else 8, "--only", "inside,ros2,zmq,zmq shm,foxglove", ROS_DOMAIN_ID=str(os.getpid() % 90))
    for line in map(json.loads, lines.splitlines()):
        if not line.get("messages"):
            raise RuntimeError(f"{line.get('client')}, {line.get('stream')}: no message came: {line}")
        bar = bars.get((line["client"], line["stream"]))
        if bar is None:
            continue
        share = line.get("bridge_p50_ms", line["p50_ms"])
        yield at_most(f"{line['client']}: {line['stream']}, ms that the bridge adds", share, bar,
                      f"whole latency p50 {line['p50_ms']:.2f}, p99 {line['p99_ms']:.2f}, jitter {line['jitter_ms']:.2f} ms; "
                      f"{line['messages']} messages, {line['dropped']:.0f} lost")


def python(quick):
    """a call of step() from Python against the same call from C++, in turn; the arrays of a frame"""
    data = run_json(ROOT / "gloam", "python", ROOT / "bench" / "python_overhead.py", BIN / "bench_step_calls")
    for scene, row in data["steps"].items():
        yield at_most(f"µs of a call of sim.step() beside its step, {scene}", row["call_us"], 5, "wall clock, against the same steps in one call, median of 7")
        yield at_most(f"µs that Python adds to a step, {scene}", row["python_adds_us"], 5, f"CPU time of the caller, median of 7 turns; C++ {row['cpp_us']:.1f} µs a step, wall {row['wall_difference_us']:+.1f} µs")
    cold, warm = data["frame_us"]
    yield at_most("µs to the arrays, pose and matrix of a frame of 640x480", cold, 50, f"right after it was rendered, caches cold; again {warm:.1f} µs; median of 30")


def trajectories(quick):
    """the step that receives a joint trajectory of any length"""
    data = run_json(BIN / "bench_trajectory_cost", ROOT / "bench" / "trajectory_joints.toml", "--repeats", 10 if quick else 50)
    costs = ", ".join(f"{cost:.0f} for {points}" for points, cost in data["receive_us"].items())
    posts = ", ".join(f"{cost / 1000:.2f} for {points}" for points, cost in data["post_us"].items())
    yield at_most("µs that a trajectory of 80,000 points adds to the step that receives it", data["receive_us"]["80000"], 200,
                  f"{data['joints']} joints, 60 s; {costs} points; a step {data['step_us']:.0f} µs; ms of the caller that posts it: {posts}")


def inverse_kinematics(quick):
    """one solution of differential inverse kinematics against Mink: the same tasks and limits"""
    folder = CACHE / "bench_ik"
    folder.mkdir(parents=True, exist_ok=True)
    sys.path.insert(0, str(ROOT / "tests" / "python"))
    import ik_models  # noqa: PLC0415
    for name, make, sites, bar in (("arm of 7 joints", ik_models.arm, ["tool"], 5),
                                   ("humanoid of 29 joints", ik_models.humanoid, ["left_palm", "right_palm", "left_sole", "right_sole"], 2)):
        pairs = []
        for _ in range(1 if quick else 5):
            ours = run_json(BIN / "bench_ik_rate", make(folder), *sites)
            pairs.append((ours["solve_us"], run_json(peer_python(), ROOT / "bench" / "peers" / "mink_rate.py", make(folder), *sites)["solve_us"]))
        yield at_least(f"inverse kinematics, {name}: Mink's time / ours", statistics.median(theirs / ours for ours, theirs in pairs), bar,
                       f"{statistics.median(p[0] for p in pairs):.1f} µs against {statistics.median(p[1] for p in pairs):.0f} µs with the faster of daqp "
                       f"and quadprog; frames of {len(sites)} sites, a posture, ranges and velocities")


def flight(quick):
    """the quadrotor's controller: a step of 1 m, hovering in gusts, and the power of hovering; in simulation time"""
    data = run_json(ROOT / "gloam", "python", ROOT / "bench" / "flight.py")
    for name, bar in (("step_forward", 1.5), ("step_up", 1.5), ("step_forward_without_motors", 1.5)):
        row = data[name]
        yield at_most(f"quadrotor, {name.replace('_', ' ')} of 1 m: s from 10 to 90 %", row["rise_s"], bar, f"overshoot {row['overshoot_percent']:.1f} %")
    for name, bar in (("hover_still", 0.01), ("hover_gusts_8", 0.3), ("hover_gusts_12", 0.5)):
        row = data[name]
        yield at_most(f"quadrotor, {name.replace('_', ' ')}: m of error, root mean square over 60 s", row["rms_m"], bar, f"at most {row['max_m']:.3f} m")
    power = data["hover_power"]
    yield at_most("quadrotor, hover: electrical power / ideal power of momentum theory", power["power_W"] / power["ideal_W"], 2.5,
                  f"{power['power_W']:.0f} W against {power['ideal_W']:.0f} W; {power['minutes_of_82_Wh']:.0f} min of 82 Wh")


# With the seconds that each takes on two cores: the first estimate of the time left.
ALL = {sim_step_rate: 15, sim_beside_cameras: 60, path_tier: 60, equal_error: 600, direct_tier: 90, direct_places: 60, view: 40, interactive_tier: 400, truth: 40, load_time: 120, import_time: 60,
       first_picture: 15, adaptive_sampling: 120, truth_at_few_samples: 900, lidar: 25, environments: 60, hfield: 25, policy: 3, gas: 20,
       effects: 90, all_effects: 75, log_rate: 60, record_cost: 300, latency: 330, python: 60, inverse_kinematics: 30, trajectories: 15, flight: 20}
