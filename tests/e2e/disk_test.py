"""Disks that are full, read-only or limited while Gloam records: one clear line, exit code 3, and everything written before is readable."""
import contextlib
import json
import resource
import subprocess
import unittest

from e2e.support import PENDULUM, PROGRAM, ProgramTest, video_frames


@contextlib.contextmanager
def small_disk(folder, options):
    """A tmpfs of its own at `folder`; skips the test where that may not be mounted."""
    folder.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)], capture_output=True, text=True)
    if mounted.returncode != 0:
        raise unittest.SkipTest("a small disk can only be mounted by root")
    try:
        yield folder
    finally:
        subprocess.run(["umount", str(folder)], check=True)


class Disk(ProgramTest):
    def record(self, out, expect, **how):
        model = self.write("m.xml", PENDULUM)
        # Noise fills a disk fastest.
        result = self.gloam("run", model, "--duration", "3000", "--out", out, "--spp", "1", "--no-denoise", "--resolution", "160x120",
                            expect=expect, **how)
        errors = [line for line in result.stderr.splitlines() if "error" in line]
        self.assertEqual(len(errors), 1, result.stderr)
        return errors[0]

    def check_readable(self, out):
        summary = json.loads((out / "summary.json").read_text())
        pictures = sorted((out / "side" / "rgb").glob("*.png"))
        self.assertGreater(len(pictures), 5)
        decoded = subprocess.run(["ffmpeg", "-v", "error", "-xerror", "-i", str(out / "side/rgb/%06d.png"), "-f", "null", "-"],
                                 capture_output=True, text=True)
        self.assertEqual((decoded.returncode, decoded.stderr), (0, ""), "every picture is whole")
        self.assertFalse(list(out.glob("**/*.tmp*")) + list(out.glob("**/*.part")), "nothing half-written is left")
        frames = video_frames(out / "side.mp4")
        self.assertGreater(frames, 5)
        self.assertLessEqual(abs(frames - len(pictures)), 40, "the video ends about where the pictures do")
        poses = (out / "side" / "poses.csv").read_text().splitlines()
        self.assertGreater(len(poses), 5)
        self.assertEqual(len({line.count(",") for line in poses[:-1]}), 1, "whole rows")
        return summary

    def check_stopped(self, summary, cause):
        self.assertRegex(summary["state"], f"^stopped: .*{cause}")
        self.assertNotEqual(summary["exit_reason"], "completed")
        self.assertIn(cause, summary["recording_error"])

    def test_a_disk_that_fills_up(self):
        with small_disk(self.folder / "disk", "size=1m") as disk:
            error = self.record(disk / "out", expect=3)
            self.assertIn("No space left", error)
            self.assertIn("disk/out", error)
            self.check_stopped(self.check_readable(disk / "out"), "No space left")

    def test_a_log_on_a_disk_that_fills_up(self):
        model = self.write("m.xml", PENDULUM)
        with small_disk(self.folder / "disk", "size=1m") as disk:
            result = self.gloam("record", model, "-o", disk / "run.mcap", "--duration", "3000", "--topics", "/tf,/contacts", expect=3)
            self.assertIn("No space left", result.stderr)
            whole = self.folder / "whole.mcap"
            recovered = subprocess.run([str(PROGRAM), "recover", str(disk / "run.mcap"), "-o", str(whole)], capture_output=True, text=True)
            self.assertIn(recovered.returncode, (0, 3), recovered.stderr)
            self.assertRegex(self.gloam("replay", whole, "--verify").stdout, r"^0 of [1-9]\d+ steps differ")

    def test_a_disk_that_is_full_from_the_start(self):
        with small_disk(self.folder / "disk", "size=64k") as disk:
            (disk / "ballast").write_bytes(bytes(60 * 1024))
            error = self.record(disk / "out", expect=1)
            self.assertIn("No space left", error)

    def test_a_disk_that_is_read_only(self):
        with small_disk(self.folder / "disk", "ro") as disk:
            self.assertIn("Read-only", self.record(disk / "out", expect=1))
            model = self.write("m.xml", PENDULUM)
            for command in ["render", "export"]:
                error = self.gloam(command, model, "--out", disk / "out", *(["--spp", "1"] if command == "render" else []), expect=1).stderr
                self.assertIn("Read-only", error)

    def test_a_file_that_may_not_grow(self):
        # Needs no root: the video reaches the limit, the pictures do not.
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))  # noqa: E731
        error = self.record(self.folder / "out", expect=3, preexec_fn=limit)
        self.assertIn("File too large", error)
        summary = self.check_readable(self.folder / "out")
        self.check_stopped(summary, "File too large")


if __name__ == "__main__":
    unittest.main()
