"""Debian 13 in a chroot: README's two commands in a fresh clone, and the wheel and the bundle where nothing is installed. In `full`.

Needs root, debootstrap, a machine whose apt has a mirror of Debian, 12 GB of disk and an hour of two cores. GLOAM_TEST_CHROOT
names a folder in which the chroots stay for the next time; GLOAM_TEST_CCACHE one of ccache that the builds share.
"""
import os
import platform
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from e2e.support import PENDULUM, ROOT

SUITE = "trixie"
CERTIFICATES = Path("/etc/ssl/certs")
PASSED_ON = re.compile(r"(?i)^(https?_proxy|no_proxy|pip_(?!cert|find_links).*|gloam_wheels)$")


def run(command, **options):
    return subprocess.run([str(part) for part in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                          **options)


def mirror():
    """The mirror of Debian that this machine's apt uses, "" if none."""
    listed = run(["apt-get", "indextargets", "--format", "$(REPO_URI) $(ORIGIN) $(SUITE) $(CODENAME)"]).stdout
    for line in listed.splitlines():
        uri, *words = line.split()
        if "Debian" in words and not any("-" in word for word in words):  # no -security, no -updates
            return uri
    return ""


def why_not():
    """Why this machine cannot do it, "" if it can."""
    if platform.machine() != "x86_64":
        return "needs an x86-64 machine"
    if os.geteuid() != 0:
        return "needs root, for chroot"
    if run(["unshare", "--mount", "true"]).returncode != 0:
        return "needs mount namespaces"
    for tool in ("debootstrap", "apt-get"):
        if not shutil.which(tool):
            return f"needs {tool}"
    if not mirror():
        return "apt has no mirror of Debian"
    return ""


class Chroot:
    """A system of its own in a folder. Mounts exist while a command runs, in a namespace that goes with it."""

    def __init__(self, folder):
        self.folder = folder

    def bootstrap(self):
        made = run(["debootstrap", "--variant=minbase", SUITE, self.folder, mirror()])
        assert made.returncode == 0, made.stdout[-3000:]
        settings = [line for line in run(["apt-config", "dump"]).stdout.splitlines() if line.startswith("Acquire::")]
        (self.folder / "etc/apt/apt.conf.d/80machine").write_text("\n".join(settings) + "\n")
        for name in ("etc/resolv.conf", "etc/hosts"):
            shutil.copyfile(f"/{name}", self.folder / name)
        (self.folder / "machine/certs").mkdir(parents=True)
        (self.folder / "machine/ccache").mkdir()

    def run(self, script, seconds=900):
        """A shell script as root, with the machine's network and nothing else of its environment."""
        mounts = [("-t proc", "proc", "proc"), ("--rbind", "/dev", "dev"), ("--bind", CERTIFICATES, "machine/certs")]
        variables = {name: value for name, value in os.environ.items() if PASSED_ON.match(name)}
        variables |= {"HOME": "/root", "PATH": "/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "PIP_CERT": "/machine/certs/ca-certificates.crt"}
        if cache := os.environ.get("GLOAM_TEST_CCACHE"):
            mounts.append(("--bind", cache, "machine/ccache"))
            variables["CCACHE_DIR"] = "/machine/ccache"
        inside = "".join(f"mount {kind} {source} {self.folder}/{target} && " for kind, source, target in mounts)
        inside += f'exec chroot {self.folder} env -i "$@"'
        assignments = [f"{name}={value}" for name, value in variables.items()]
        return run(["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c", inside, "sh", *assignments, "sh", "-ec", script],
                   timeout=seconds)


@unittest.skipIf(why_not(), why_not())
class Debian13(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        kept = os.environ.get("GLOAM_TEST_CHROOT")
        if kept:
            cls.folder = Path(kept)
            cls.folder.mkdir(parents=True, exist_ok=True)
        else:
            folder = tempfile.TemporaryDirectory(prefix="gloam_debian13_")
            cls.addClassCleanup(folder.cleanup)
            cls.folder = Path(folder.name)
        cls.base = Chroot(cls.folder / "base")
        if not (cls.base.folder / "machine").exists():
            shutil.rmtree(cls.base.folder, ignore_errors=True)
            cls.base.bootstrap()

    def fresh(self, name):
        """A copy of the system as debootstrap made it."""
        folder = self.folder / name
        shutil.rmtree(folder, ignore_errors=True)
        copied = run(["cp", "-a", "--reflink=auto", self.base.folder, folder])
        self.assertEqual(copied.returncode, 0, copied.stdout)
        return Chroot(folder)

    def succeeds(self, chroot, script, seconds=900):
        result = chroot.run(script, seconds)
        self.assertEqual(result.returncode, 0, f"{script}\n{result.stdout[-5000:]}")
        return result.stdout

    def test_readme_commands_in_a_fresh_clone(self):
        commands = re.search(r"^```sh\n(.*?)^```", (ROOT / "README.md").read_text(), re.M | re.S).group(1).splitlines()
        commands = [line.split("#")[0].strip() for line in commands]
        self.assertEqual(commands, ["./gloam demo --quick", "./gloam test fast"])
        chroot = self.fresh("build")
        clone = chroot.folder / "root/gloam"
        listed = subprocess.check_output(["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"], cwd=ROOT)
        subprocess.run(["git", "clone", "-q", "--no-hardlinks", ROOT, clone], check=True)  # the rules of the tests read its history
        subprocess.run(["tar", "--null", "--ignore-failed-read", "-T", "-", "-cf", f"{clone}.tar"], cwd=ROOT, input=listed, check=True)
        subprocess.run(["tar", "-xf", f"{clone}.tar", "-C", clone], check=True)
        if os.environ.get("GLOAM_TEST_CCACHE"):
            self.succeeds(chroot, "apt-get update && apt-get install -y --no-install-recommends ccache")
        printed = self.succeeds(chroot, f"cd /root/gloam && {commands[0]}", 7200)
        self.assertIn("gloam: Debian GNU/Linux 13 (trixie): supported", printed)
        version = self.succeeds(chroot, "cd /root/gloam && ./gloam --version")
        self.assertRegex(version, r"Embree 4\.")
        pendulum = chroot.folder / "root/m.xml"
        pendulum.write_text(PENDULUM)
        bridged = self.succeeds(chroot, "cd /root/gloam && ./gloam run /root/m.xml --ros2 --duration 1")
        self.assertIn("gloam: ros2: node 'gloam'", bridged)
        printed = self.succeeds(chroot, f"cd /root/gloam && {commands[1]}", 7200)
        self.assertRegex(printed, r"\n[1-9]\d* passed, 0 failed")

    def test_the_wheel_where_nothing_is_installed(self):
        made = run([ROOT / "gloam", "wheel", self.folder / "wheels", "--python", "3.13"], timeout=3600,
                   env={**os.environ, "GLOAM_PRESET": "release"})
        if "python3.13 was not found" in made.stdout:
            self.skipTest("needs Python 3.13 on this machine, to build the wheel")
        self.assertEqual(made.returncode, 0, made.stdout[-3000:])
        wheel = max((self.folder / "wheels").glob("*cp313*.whl"), key=lambda file: file.stat().st_mtime)
        chroot = self.fresh("wheel")
        shutil.copy(wheel, chroot.folder / "root")
        self.succeeds(chroot, "apt-get update && apt-get install -y --no-install-recommends python3-venv && python3 -m venv /root/venv"
                      f" && /root/venv/bin/pip install /root/{wheel.name}", 1800)
        printed = self.succeeds(chroot, "cd /root && venv/bin/python -c \"import gloam; s = gloam.load(gloam.home() / 'examples' / 'demo.toml', seed=1);"
                                " s.run_until(0.1); f = s.cameras['quadruped/front'].render(('rgb',), width=64, height=48, spp=1);"
                                " print(f.rgb.shape, s.hash)\"")
        self.assertIn("(48, 64, 3)", printed)

    def test_the_bundle_where_nothing_is_installed(self):
        bundle = ROOT / "build" / "gloam.tar.gz"
        if not bundle.exists():
            self.skipTest("there is no bundle: ./gloam pack makes it")
        chroot = self.fresh("bundle")
        subprocess.run(["tar", "-xf", bundle, "-C", chroot.folder / "root"], check=True)
        printed = self.succeeds(chroot, "cd /root && gloam/bin/gloam run gloam/share/gloam/examples/demo.toml --duration 0.1 --resolution 64x48"
                                " --spp 1 --device cpu --out out && ls out && ! ldd gloam/bin/gloam | grep 'not found'"
                                " && gloam/bin/gloam report out -o out.html && gloam/bin/gloam export out/metrics.csv --to parquet --out out.parquet")
        self.assertIn("summary.json", printed)


if __name__ == "__main__":
    unittest.main()
