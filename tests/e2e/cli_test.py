"""The command line as a user meets it: help, exit codes, one clear line for every mistake."""
import json
import os
import signal
import subprocess
import time
import unittest

from e2e.support import PENDULUM, PROGRAM, ProgramTest

COMMANDS = ["demo", "run", "render", "info", "export", "completion"]


class Help(ProgramTest):
    def test_every_command_has_help_with_an_example(self):
        for command in COMMANDS:
            text = self.gloam(command, "--help").stdout
            self.assertIn("Example", text, command)

    def test_version_names_mujoco(self):
        self.assertIn("MuJoCo 4.0.1", self.gloam("--version").stdout)

    def test_completion_for_every_shell_parses(self):
        for shell in ["bash", "zsh", "fish"]:
            script = self.gloam("completion", shell).stdout
            for command in COMMANDS:
                self.assertIn(command, script)
        script = self.write("completion.bash", self.gloam("completion", "bash").stdout)
        answer = subprocess.run(["bash", "-c", f"source {script}; COMP_WORDS=(gloam re); COMP_CWORD=1; _gloam; echo ${{COMPREPLY[@]}}"],
                                capture_output=True, text=True)
        self.assertIn("render", answer.stdout, answer.stderr)


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

    def test_unknown_command_and_option_are_usage_errors(self):
        self.gloam("rnu", expect=2)
        self.gloam("run", "--no-such-option", "x.xml", expect=2)
        self.gloam(expect=2)

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


class Work(ProgramTest):
    def test_run_prints_the_same_hash_twice(self):
        model = self.write("m.xml", PENDULUM)
        first = json.loads(self.gloam("run", model, "--duration", "1", "--json").stdout)
        second = json.loads(self.gloam("run", model, "--duration", "1", "--json", "--threads", "1").stdout)
        self.assertEqual(first["state_hash"], second["state_hash"])
        self.assertEqual(first["steps"], 500)

    def test_info_as_json(self):
        info = json.loads(self.gloam("info", self.write("m.xml", PENDULUM), "--json").stdout)
        self.assertEqual([body["name"] for body in info["bodies"]], ["world", "arm"])
        self.assertEqual(info["nu"], 1)
        self.assertEqual([camera["name"] for camera in info["cameras"]], ["side"])

    def test_render_writes_a_picture(self):
        model = self.write("m.xml", PENDULUM)
        result = self.gloam("render", model, "--spp", "2", "--resolution", "64x48", "--output", "rgb,depth,segmentation")
        for line in result.stdout.splitlines():
            self.assertGreater((self.folder / line).stat().st_size, 50, line)
        self.assertIn("side.png", result.stdout)

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

    def test_ctrl_c_finishes_the_files(self):
        model = self.write("m.xml", PENDULUM)
        process = subprocess.Popen([str(PROGRAM), "run", str(model), "--duration", "1000", "--out", "out", "--spp", "1", "--resolution", "64x48"],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(3)
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130, stderr)
        self.assertTrue((self.folder / "out" / "summary.json").exists(), "what was recorded is finished")


if __name__ == "__main__":
    unittest.main()
