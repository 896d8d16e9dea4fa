"""The command line as a user meets it: help, exit codes, one clear line for every mistake."""
import json
import os
import re
import resource
import signal
import socket
import subprocess
import time
import unittest

import fetch_data
from e2e.support import PENDULUM, PROGRAM, ROOT, ProgramTest, video_frames

COMMANDS = ["demo", "run", "render", "info", "export", "evaluate", "report", "check", "cache", "schema", "completion"]
SCRIPT_COMMANDS = [name for names in re.findall(r"^  (\w+(?: \| \w+)*)\)", (ROOT / "gloam").read_text(), re.M) for name in names.split(" | ")]


class Help(ProgramTest):
    def test_every_command_has_help_with_an_example(self):
        for command in COMMANDS:
            text = self.gloam(command, "--help").stdout
            self.assertIn("Example", text, command)

    def test_help_names_every_command(self):
        text = self.gloam("--help").stdout
        self.assertIn("bench", SCRIPT_COMMANDS)
        for command in COMMANDS + SCRIPT_COMMANDS:
            self.assertIn(command, text)

    def test_schemas_are_json(self):
        self.assertIn("robot", json.loads(self.gloam("schema", "scene").stdout)["properties"])
        self.assertIn("mujoco", json.loads(self.gloam("schema", "model").stdout)["properties"])
        self.assertIn("scene", self.gloam("schema", "scenes", expect=2).stderr)

    def test_version_names_mujoco(self):
        self.assertIn("MuJoCo 4.0.1", self.gloam("--version").stdout)

    def test_completion_for_every_shell_parses(self):
        for shell in ["bash", "zsh", "fish"]:
            script = self.gloam("completion", shell).stdout
            for command in COMMANDS + SCRIPT_COMMANDS:
                self.assertIn(command, script)
        script = self.write("completion.bash", self.gloam("completion", "bash").stdout)
        answer = subprocess.run(["bash", "-c", f"source {script}; COMP_WORDS=(gloam re); COMP_CWORD=1; _gloam; echo ${{COMPREPLY[@]}}"],
                                capture_output=True, text=True)
        self.assertIn("render", answer.stdout, answer.stderr)


class Labels(ProgramTest):
    def test_stills_have_the_table_of_recordings_without_what_ids_do_not_show(self):
        model = self.write("m.xml", "<mujoco><worldbody><body name='b' pos='0 0 .2'><freejoint/><geom name='g' size='.1'/><site name='mark'/></body></worldbody></mujoco>")
        small = ["--camera", "free", "--output", "segmentation", "--sites", "--resolution", "16x16", "--spp", "1"]
        self.gloam("run", model, *small, "--duration", "0.01", "--out", "r")
        self.gloam("render", model, *small, "--out", "s")
        recorded, still = (json.loads((self.folder / folder / "labels.json").read_text()) for folder in "rs")
        self.assertEqual(still, recorded)
        self.assertEqual([(row["geom"], row["geom_id"], row["body_id"]) for row in still["parts"]], [("g", 0, 1)])


class Encodings(ProgramTest):
    """Files in Windows-1252, as editors there write them without being asked."""

    def test_names_are_utf8_in_all_that_comes_out(self):
        (self.folder / "m.xml").write_bytes("<?xml version='1.0' encoding='ISO-8859-1'?><mujoco><worldbody><light pos='0 0 3'/><body name='M\u00fcller'><freejoint/>"
                                            "<geom name='r\u00e4d' size='.1'/></body></worldbody></mujoco>".encode("latin-1"))
        (self.folder / "s.toml").write_bytes("[[robot]]\nname = 'k\u00fcche'\nfile = 'm.xml'\n".encode("latin-1"))
        self.assertIn("M\u00fcller", self.gloam("info", "m.xml", "--json").stdout)
        self.assertIn("k\u00fcche/M\u00fcller", self.gloam("info", "s.toml", "--json").stdout)
        self.gloam("run", "s.toml", "--duration", "0.01", "--output", "segmentation,state", "--resolution", "8x8", "--spp", "1", "--out", "r")
        self.assertIn("k\u00fcche/M\u00fcller", (self.folder / "r" / "labels.json").read_text(encoding="utf-8"))
        self.assertIn("k\u00fcche/M\u00fcller", (self.folder / "r" / "state.csv").read_text(encoding="utf-8"))
        self.assertIn("passed", self.gloam("check", "m.xml", "s.toml").stdout)


class Cache(ProgramTest):
    def test_lists_and_clears_what_it_keeps(self):
        obj = self.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        scene = self.write("s.toml", f'[[visual]]\nname = "v"\nfile = "{obj.name}"\n[[camera]]\nname = "c"\nposition = [0, 0, 3]\n')
        self.gloam("render", scene, "--spp", "1", "--resolution", "8x8", "--out", "out")
        self.gloam("cache", "clear", "models")  # kept only where compiling took long, as on a busy machine
        theirs = self.write("cache/visuals/theirs.model", "not Gloam's")
        text = self.gloam("cache").stdout
        self.assertIn(str(self.folder / "cache" / "visuals"), text)
        self.assertIn("1 entry,", text)
        data = json.loads(self.gloam("cache", "--json").stdout)
        self.assertEqual([kind["name"] for kind in data["kinds"]], ["models", "visuals", "bvhs", "patterns", "light", "hulls", "scenes"])
        self.assertEqual([kind["entries"] for kind in data["kinds"]], [0, 1, 0, 0, 0, 0, 0])
        self.assertEqual(data["bytes"], data["kinds"][1]["bytes"])
        self.assertEqual(data["limit_bytes"], 10 << 30)
        self.assertIsNone(data["kinds"][0]["newest_use"])
        self.assertRegex(data["kinds"][1]["newest_use"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.gloam("cache", "clear", "models")
        self.assertEqual(json.loads(self.gloam("cache", "--json").stdout)["kinds"][1]["entries"], 1)
        removed = json.loads(self.gloam("cache", "clear", "--json").stdout)["removed"]
        self.assertEqual([kind["entries"] for kind in removed], [0, 1, 0, 0, 0, 0, 0])
        self.assertEqual(list((self.folder / "cache/visuals").iterdir()), [theirs])

    def test_without_room_nothing_is_kept(self):
        obj = self.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        scene = self.write("s.toml", f'[[visual]]\nname = "v"\nfile = "{obj.name}"\n[[camera]]\nname = "c"\nposition = [0, 0, 3]\n')
        for size, entries in [("0", 0), ("1K", 1)]:
            self.gloam("render", scene, "--spp", "1", "--resolution", "8x8", "--out", f"out{size}", env={"GLOAM_CACHE_SIZE": size})
            self.assertEqual(json.loads(self.gloam("cache", "--json").stdout)["kinds"][1]["entries"], entries)


class Check(ProgramTest):
    """gloam check: one line a model, exit code 1 when one is not what stock MuJoCo makes of it or does not come back."""

    def test_models_and_scenes_that_come_back(self):
        model = self.write("m.xml", PENDULUM)
        scene = self.write("s.toml", '[[robot]]\nname = "a"\nfile = "m.xml"\n')
        text = self.gloam("check", model, scene).stdout.splitlines()
        self.assertRegex(text[0], r"m.xml: 2 bodies, 1 joints, 2 geoms: equal to stock MuJoCo's model; equal to its export \(\d+ fields, export \d+\.\d+ MB, ")
        self.assertRegex(text[1], r"s.toml: 2 bodies, 1 joints, 3 geoms: equal to its export \(")
        self.assertEqual(text[2], "2 of 2 passed")
        data = json.loads(self.gloam("check", "--json", model).stdout)
        self.assertEqual((data["passed"], data["failed"]), (1, 0))
        self.assertEqual((data["models"][0]["stock_loads"], data["models"][0]["differs_from_stock"], data["models"][0]["differs_from_export"]), (True, [], []))
        self.assertGreater(data["models"][0]["fields_compared"], 400)

    def test_what_does_not_come_back_fails(self):
        self.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        lossy = self.write("m.toml", '[mujoco]\n[mujoco.asset]\n[[mujoco.asset.mesh]]\nname = "m"\nfile = "m.obj"\nneedsdf = true\n'
                                     '[mujoco.worldbody]\n[[mujoco.worldbody.geom]]\ntype = "mesh"\nmesh = "m"\n')
        self.assertRegex(self.gloam("check", lossy, expect=1).stdout, "m.toml: .* FAILED: differs from its export in ")

    def test_what_does_not_load_fails(self):
        good, bad = self.write("m.xml", PENDULUM), self.write("bad.xml", "<mujoco>\n<worldbdy/></mujoco>")
        text = self.gloam("check", bad, good, "none.xml", expect=1).stdout.splitlines()
        self.assertRegex(text[0], "bad.xml: FAILED: .*bad.xml:2: .*; stock MuJoCo does not load it: ")
        self.assertIn("m.xml: 2 bodies", text[1])
        self.assertRegex(text[2], "none.xml: FAILED: there is no file")
        self.assertEqual(text[3], "1 of 3 passed")
        outside = self.write("inner/m.xml", '<mujoco><include file="../part.xml"/></mujoco>')
        self.write("part.xml", PENDULUM)
        self.assertRegex(self.gloam("check", "--strict", outside, expect=1).stdout, "outside.*; stock MuJoCo loads it")

    def test_robots_of_others(self):
        robots = fetch_data.default_folder() / "mjlab/mjlab/asset_zoo/robots"
        if not robots.is_dir():
            self.skipTest("no third-party robots: run tests/fetch_data.py")
        files = sorted(file for file in robots.rglob("*.xml"))
        data = json.loads(self.gloam("check", "--json", *files, timeout=600).stdout)
        self.assertEqual([model["file"] for model in data["models"] if not model["stock_loads"] or not model["passed"]], [])
        self.assertEqual(data["passed"], len(files))


class Mistakes(ProgramTest):
    """Bad input: one line that names the file, the line, the cause; the right exit code; no crash."""

    def complains(self, expect, *arguments, words=(), **more):
        result = self.gloam(*arguments, expect=expect, **more)
        lines = [line for line in result.stderr.splitlines() if "error" in line.lower()]
        self.assertEqual(len(lines), 1, result.stderr)
        for word in words:
            self.assertIn(word, lines[0])
        self.assertEqual(result.stdout, "")
        return lines[0]

    def test_caches_that_cannot_be_used(self):
        self.complains(2, "cache", "claer", words=["claer"])
        self.complains(2, "cache", "clear", "modles", words=["there is no cache 'modles'", "did you mean 'models'?"])
        self.complains(1, "cache", env={"GLOAM_CACHE_SIZE": "much"}, words=["GLOAM_CACHE_SIZE is 'much'", "20G"])
        model = self.write("m.xml", PENDULUM)
        for size in ("abc", "-1", "10 G", "1e9", "99999999999G"):  # whatever is done
            for command in (["info", model], ["render", model, "--out", "out"]):
                self.complains(1, *command, env={"GLOAM_CACHE_SIZE": size}, words=[f"GLOAM_CACHE_SIZE is '{size}'", "20G"])
        file = self.write("file", "no folder")
        for arguments in (["cache"], ["cache", "clear"]):
            self.complains(1, *arguments, env={"GLOAM_CACHE": str(file)}, words=[str(file), "cannot read the cache"])

    def test_unknown_command_and_option_are_usage_errors(self):
        self.complains(2, "rnu", words=["gloam: error: unknown command 'rnu'", "did you mean 'run'?"])
        self.complains(2, "--quiet", "galery", "--quick", words=["'galery'", "did you mean 'gallery'?"])
        self.complains(2, "help", words=["'help'", "did you mean '--help'?"])
        self.complains(2, "run", "--no-such-option", "x.xml", words=["gloam: error: unknown option '--no-such-option'"])
        self.complains(2, "render", "x.xml", "--resolutoin=64x48", words=["'--resolutoin'", "did you mean '--resolution'?"])
        self.complains(2, "render", "x.xml", "--qiet", words=["'--qiet'", "did you mean '--quiet'?"])
        self.complains(2, "render", "x.xml", "--spp", "many", words=["spp", "many", "--help"])
        self.complains(2, words=["--help"])

    def test_output_that_nobody_can_keep(self):
        model = self.write("robot.xml", PENDULUM)
        for arguments in (["info", model], ["completion", "bash"], ["--help"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run([PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), arguments)
            self.assertIn("gloam: error: cannot write to standard output", done.stderr)
        for command in ("completion fish", f"info {model}"):
            quiet = subprocess.run(["bash", "-c", f"set -o pipefail; {PROGRAM} {command} | true"], capture_output=True, text=True)
            self.assertEqual((quiet.returncode, quiet.stderr), (0, ""), f"{command}: a reader that has seen enough")

    def test_info_wants_a_file_or_the_schema(self):
        self.complains(2, "info", words=["FILE"])
        self.complains(2, "info", "--schema", "m.xml", words=["--schema"])

    def test_missing_file(self):
        self.complains(1, "run", "missing.xml", words=["missing.xml", "there is no file"])

    def test_unknown_key_suggests_the_nearest(self):
        self.write("robot.xml", PENDULUM)
        scene = self.write("scene.toml", '[sim]\ndurration = 1\n[[robot]]\nname = "a"\nfile = "robot.xml"\n')
        self.complains(1, "run", scene, words=["scene.toml:2", "durration", "duration"])

    def test_wrong_type_names_line(self):
        scene = self.write("scene.toml", '[sim]\nduration = "long"\n')
        self.complains(1, "run", scene, words=["scene.toml:2", "duration"])

    def test_nan_is_refused(self):
        scene = self.write("scene.toml", "[sim]\nduration = nan\n")
        self.complains(1, "run", scene, words=["scene.toml:2"])

    def test_missing_mesh_names_the_file(self):
        model = self.write("m.xml", '<mujoco><asset><mesh name="a" file="gone.obj"/></asset><worldbody><geom type="mesh" mesh="a"/></worldbody></mujoco>')
        self.complains(1, "run", model, words=["gone.obj"])

    def test_broken_xml_names_the_line(self):
        model = self.write("m.xml", "<mujoco>\n<worldbody>\n<geom type=sphere/>\n</worldbody></mujoco>")
        self.complains(1, "info", model, words=["m.xml"])

    def test_cyclic_include(self):
        self.write("a.xml", '<mujoco><include file="b.xml"/></mujoco>')
        self.write("b.xml", '<mujoco><include file="a.xml"/></mujoco>')
        self.complains(1, "info", self.folder / "a.xml", words=["include"])

    def test_path_that_leaves_its_root(self):
        self.write("secret.obj", "v 0 0 0\n")
        model = self.write("models/m.xml", '<mujoco><asset><mesh name="a" file="/etc/passwd"/></asset><worldbody><geom type="mesh" mesh="a"/></worldbody></mujoco>')
        self.complains(1, "info", model, "--strict", words=["/etc/passwd"])

    def test_path_that_leaves_its_root_by_the_rules(self):
        # Four levels up is as far as a model may look by itself; --root widens that.
        self.write("secret.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        model = self.write("1/2/3/4/5/m.xml", '<mujoco><asset>\n<mesh name="a" file="../../../../../secret.obj"/></asset>'
                           '<worldbody><geom type="mesh" mesh="a"/></worldbody></mujoco>')
        self.complains(1, "info", model, words=["m.xml:2", "secret.obj", "--root"])
        self.gloam("info", model, "--root", self.folder)
        (self.folder / "1/2/3/4/5/link.obj").symlink_to(self.folder / "secret.obj")
        link = self.write("1/2/3/4/5/l.xml", '<mujoco><asset><mesh name="a" file="link.obj"/></asset><worldbody><geom type="mesh" mesh="a"/></worldbody></mujoco>')
        self.complains(1, "info", link, words=["link.obj", "symbolic link"])

    def test_unknown_package(self):
        mesh = '<geometry><mesh filename="package://nowhere/a.stl"/></geometry>'
        model = self.write("r.urdf", f'<robot name="r"><link name="a"><visual>{mesh}</visual><collision>{mesh}</collision></link></robot>')
        self.complains(1, "info", model, words=["r.urdf", "nowhere", "--package"])

    def test_files_that_are_no_scenes(self):
        self.complains(1, "run", self.write("empty.toml", ""), words=["empty.toml", "robot"])
        self.complains(1, "run", self.folder, words=["not a file"])
        (self.folder / "noise.xml").write_bytes(bytes(i * 37 % 251 for i in range(50000)))
        self.complains(1, "info", self.folder / "noise.xml", words=["noise.xml"])

    def test_numbers_out_of_range(self):
        model = self.write("m.xml", PENDULUM)
        for option, value in [("--duration", "0"), ("--duration", "inf"), ("--duration", "-1"), ("--timestep", "nan"), ("--speed", "x"),
                              ("--spp", "0"), ("--threads", "-3"), ("--port", "70000"), ("--max-depth", "65")]:
            error = self.gloam("run", model, option, value, expect=2).stderr
            self.assertIn(option, error)
            self.assertLess(len(error), 200, "one clear line")
        self.gloam("render", model, "--time", "inf", expect=2)
        self.complains(1, "run", model, "--timestep", "1e6", words=["timestep"])
        self.complains(1, "run", model, "--duration", "1e300", words=["duration"])

    def test_texture_that_is_a_text_file(self):
        self.write("t.png", "this is no picture")
        model = self.write("m.xml", '<mujoco><asset><texture name="t" type="2d" file="t.png"/><material name="m" texture="t"/></asset>'
                           '<worldbody><geom size="1" material="m"/></worldbody></mujoco>')
        self.complains(1, "info", model, words=["t.png"])

    def test_absurd_resolution(self):
        model = self.write("m.xml", PENDULUM)
        self.complains(2, "render", model, "--resolution", "1000000x1000000", words=["resolution"])
        self.complains(2, "render", model, "--resolution", "640", words=["resolution"])

    def test_unknown_camera_suggests(self):
        model = self.write("m.xml", PENDULUM)
        self.complains(1, "render", model, "--camera", "sid", words=["sid", "side"])
        self.complains(1, "run", model, "--camera", "sid", "--out", "out", words=["sid", "side"])
        self.complains(1, "run", model, "--camera", "sid", "--view", "--port", "0", words=["sid", "side"])
        self.assertFalse((self.folder / "out").exists())

    def test_port_in_use(self):
        model = self.write("m.xml", PENDULUM)
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = str(taken.getsockname()[1])
            self.complains(1, "run", model, "--view", "--port", port, words=["port " + port, "in use"])

    def test_a_picture_that_memory_cannot_hold(self):
        model = self.write("m.xml", PENDULUM)
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))  # noqa: E731
        self.complains(1, "render", model, "--resolution", "16384x16384", "--spp", "1", words=["memory"], preexec_fn=limit)
        self.complains(1, "run", model, "--resolution", "16384x16384", "--output", "depth_png", "--duration", "0.1", "--out", "out", words=["memory"],
                       preexec_fn=limit)
        self.assertFalse((self.folder / "out").exists())

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_no_write_permission(self):
        model = self.write("m.xml", PENDULUM)
        (self.folder / "locked").mkdir(mode=0o500)
        self.complains(1, "run", model, "--duration", "0.1", "--out", self.folder / "locked" / "out", words=["locked"])

    def test_results_path_is_a_file(self):
        model = self.write("m.xml", PENDULUM)
        self.write("out", "")
        self.complains(1, "run", model, "--duration", "0.1", "--out", self.folder / "out", words=["out"])

    def test_a_model_that_diverges_stops_and_says_so(self):
        model = self.write("m.xml", '<mujoco><option timestep="0.1"/><worldbody><body name="b"><joint name="spring" type="slide" stiffness="1e9" ref="0"/>'
                           '<geom size="0.1" mass="0.001"/></body></worldbody><keyframe><key qpos="1"/></keyframe>'
                           '<actuator><motor joint="spring" gear="1e12" ctrlrange="-1 1"/></actuator></mujoco>')
        result = self.gloam("run", model, "--duration", "60", expect=3)
        self.assertIn("diverged", result.stderr)
        result = self.gloam("run", model, "--duration", "60", "--out", "out", "--spp", "1", "--resolution", "64x48", expect=3)
        summary = json.loads((self.folder / "out" / "summary.json").read_text())
        self.assertIn("diverged", summary["exit_reason"])
        self.assertLess(summary["steps"], 600)


class Work(ProgramTest):
    def test_run_prints_the_same_hash_twice(self):
        model = self.write("m.xml", PENDULUM)
        first = json.loads(self.gloam("run", model, "--duration", "1", "--json").stdout)
        second = json.loads(self.gloam("run", model, "--duration", "1", "--json", "--threads", "1").stdout)
        self.assertEqual(first["state_hash"], second["state_hash"])
        recorded = json.loads(self.gloam("run", model, "--duration", "1", "--json", "--out", "out", "--spp", "1", "--resolution", "64x48").stdout)
        self.assertEqual(first["state_hash"], recorded["state_hash"])
        self.assertEqual(first["steps"], 500)

    def test_info_as_json(self):
        info = json.loads(self.gloam("info", self.write("m.xml", PENDULUM), "--json").stdout)
        self.assertEqual([body["name"] for body in info["bodies"]], ["world", "arm"])
        self.assertEqual(info["nu"], 1)
        self.assertEqual([camera["name"] for camera in info["cameras"]], ["side"])

    def test_the_schema_is_mirrored_whole(self):
        schema = json.loads(self.gloam("info", "--schema", "--json").stdout)
        self.assertEqual((schema["mirrored"], schema["missing"]), (schema["total"], []))
        self.assertGreaterEqual(schema["attributes"]["total"], 1900)
        self.assertGreaterEqual(schema["fields"]["total"], 464)
        self.assertIn("mujoco/actuator/position/kp", schema["field_attributes"]["mjsActuator.gainprm"])
        self.assertIn("mjsActuator.gainprm", schema["attribute_fields"]["mujoco/actuator/position/kp"])

    def test_a_still_takes_the_settings_of_a_run(self):
        model = self.write("robot.xml", PENDULUM)
        pictures = []
        for settings in ([], ["--seed", "2"], ["--set", "render.max_depth=1"]):
            self.gloam("render", model, "--spp", "1", "--no-denoise", "--resolution", "32x24", "--out", "out", *settings)
            pictures.append((self.folder / "out" / "side.png").read_bytes())
        self.assertEqual(len(set(pictures)), 3)

    def test_render_writes_a_picture(self):
        model = self.write("m.xml", PENDULUM)
        result = self.gloam("render", model, "--spp", "2", "--resolution", "64x48", "--output", "rgb,depth,segmentation")
        for line in result.stdout.splitlines():
            self.assertGreater((self.folder / line).stat().st_size, 50, line)
        self.assertIn("side.png", result.stdout)

    def test_stills_have_labels_and_files_of_their_own(self):
        model = self.write("m.xml", """<mujoco><worldbody><geom name="floor" type="plane" size="1 1 .1"/>
            <camera name="a/b" pos="0 0 2"/><camera name="a_b" pos="0 0 2"/><camera name="A_B" pos="0 0 2"/>
            <body><joint/><geom size=".1"/></body></worldbody><keyframe><key qpos="1"/><key name="home" qpos="2"/></keyframe></mujoco>""")
        small = ("--spp", "1", "--resolution", "16x16", "--output", "segmentation", "--out", "stills")
        files = self.gloam("render", model, "--keyframe", "home", *small).stdout.lower().split()
        self.assertEqual(len(files), 9)
        self.assertEqual(len(set(files)), 9)
        labels = json.loads((self.folder / "stills" / "labels.json").read_text())
        self.assertEqual([(p["geom"], p["geom_id"], p["body_id"]) for p in labels["parts"]],
                         [("floor", 0, 0), ("body 1 geom 1 (sphere)", 1, 1)])
        cameras = json.loads((self.folder / "stills" / "cameras.json").read_text())["cameras"]
        self.assertEqual([c["name"] for c in cameras], ["a/b", "a_b", "A_B"])
        self.gloam("info", model, "--keyframe", "0")
        self.gloam("run", model, "--keyframe", "home", "--duration", "0.01")

    def test_export_loads_again(self):
        model = self.write("m.xml", PENDULUM)
        self.gloam("export", model, "--out", "exported")
        first = json.loads(self.gloam("run", model, "--duration", "0.5", "--json").stdout)
        second = json.loads(self.gloam("run", self.folder / "exported" / "scene.xml", "--duration", "0.5", "--json").stdout)
        self.assertEqual(first["state_hash"], second["state_hash"])

    def test_recorded_run_holds_what_was_asked(self):
        model = self.write("m.xml", PENDULUM)
        self.gloam("run", model, "--duration", "0.5", "--out", "out", "--spp", "1", "--resolution", "64x48")
        summary = json.loads((self.folder / "out" / "summary.json").read_text())
        self.assertEqual(summary["steps"], 250)
        self.assertTrue(list((self.folder / "out").glob("**/*.mp4")))
        # A second start does not destroy the first run's results.
        self.gloam("run", model, "--duration", "0.5", "--out", "out", expect=2)
        self.gloam("run", model, "--duration", "0.5", "--out", "out", "--overwrite", "--spp", "1", "--resolution", "64x48")

    def stopped_by(self, number, *arguments, started):
        """Starts the program, waits until started() holds, sends it the signal; returns its exit code and stderr."""
        with open(self.folder / "stderr.txt", "w") as stderr:
            process = subprocess.Popen([str(PROGRAM), *map(str, arguments)], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=stderr,
                                       preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),  # nohup has it ignored
                                       env={**os.environ, "GLOAM_CACHE": str(self.folder / "cache"), "TMPDIR": str(self.folder)})
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)  # before the other; does nothing to one that has ended
        deadline = time.time() + 60
        while not started() and process.poll() is None and time.time() < deadline:
            time.sleep(0.05)
        process.send_signal(number)
        return process.wait(timeout=60), self.said()

    def said(self):
        return (self.folder / "stderr.txt").read_text()

    def test_ctrl_c_finishes_the_files(self):
        model = self.write("m.xml", PENDULUM)
        for number in [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGXCPU]:
            out = self.folder / f"out{int(number)}"
            code, stderr = self.stopped_by(number, "run", model, "--duration", "1e6", "--out", out, "--spp", "1", "--resolution", "64x48",
                                           started=lambda: (out / "side/rgb/000003.png").exists())
            self.assertEqual(code, 130, stderr)
            errors = [line for line in stderr.splitlines() if "error" in line]
            self.assertEqual(errors, ["gloam: error: interrupted"])
            summary = json.loads((out / "summary.json").read_text())
            self.assertEqual(summary["state"], "finished")
            frames = summary["cameras"][0]["frames"]
            self.assertEqual(len(list((out / "side/rgb").glob("*.png"))), frames)
            self.assertEqual(video_frames(out / "side.mp4"), frames)

    def test_ctrl_c_ends_a_still_and_a_view(self):
        model = self.write("m.xml", PENDULUM)
        begin = time.time()
        code, stderr = self.stopped_by(signal.SIGINT, "render", model, "--time", "1e6", started=lambda: time.time() > begin + 1)
        self.assertEqual(code, 130, stderr)
        code, stderr = self.stopped_by(signal.SIGINT, "run", model, "--view", "--port", "0", started=lambda: "gloam: open" in self.said())
        self.assertEqual(code, 0, stderr)

    def test_ctrl_c_does_not_wait_for_mujoco(self):
        copies = '<replicate count="100000" offset="1 0 0"><body><joint/><geom size=".1"/></body></replicate>'  # takes it a quarter of an hour
        model = self.write("m.xml", f"<mujoco><worldbody>{copies}</worldbody></mujoco>")
        for command in (["run", "--out", "out"], ["render"], ["info"], ["check"]):
            begin = []
            started = lambda: "loading m.xml in MuJoCo" in self.said() and not begin.append(time.time())  # noqa: E731
            code, stderr = self.stopped_by(signal.SIGINT, *command, model, started=started)
            self.assertEqual(code, 130, stderr)
            self.assertLess(time.time() - begin[0], 5)
            self.assertEqual([line for line in stderr.splitlines() if "error" in line], ["gloam: error: interrupted"])
            self.assertFalse((self.folder / "out").exists())
            self.assertEqual(list(self.folder.glob("gloam_check_*")), [], "no export is left")


if __name__ == "__main__":
    unittest.main()
