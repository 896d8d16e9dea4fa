"""The live page in a real browser: a picture that lives, controls that work, nothing in the console."""
import re
import signal
import subprocess
import time
import unittest

from e2e import browser
from e2e.support import PROGRAM, ProgramTest

SCENE = """<mujoco model="swing">
  <visual><global offwidth="320" offheight="240"/></visual>
  <worldbody>
    <light pos="0 -2 3" dir="0 0.6 -1"/>
    <geom name="floor" type="plane" size="2 2 0.1" rgba=".5 .6 .5 1"/>
    <body name="ball" pos="0 0 1">
      <joint name="slide" type="slide" axis="1 0 0" stiffness="40" damping="1"/>
      <geom name="ball" size="0.3" mass="1" rgba="0.8 0.2 0.2 1"/>
    </body>
    <camera name="side" pos="0 -3 1" xyaxes="1 0 0 0 0 1"/>
  </worldbody>
</mujoco>
"""

# Mean red of the canvas in its left and right half: where the ball is, and that there is a picture at all.
REDNESS = """(() => {
  const canvas = document.getElementById("picture"), w = canvas.width, h = canvas.height;
  const copy = new OffscreenCanvas(w, h).getContext("2d", { willReadFrequently: true });
  copy.drawImage(canvas, 0, 0);
  const pixels = copy.getImageData(0, 0, w, h).data, sum = [0, 0];
  for (let i = 0; i < w * h; ++i) sum[i % w < w / 2 ? 0 : 1] += Math.max(0, pixels[4 * i] - pixels[4 * i + 1]);
  return sum.map((s) => s / (w * h));
})()"""


@unittest.skipUnless(browser.find(), "there is no Chromium on this machine")
class ViewTest(ProgramTest):
    def setUp(self):
        super().setUp()
        scene = self.write("swing.xml", SCENE)
        self.program = subprocess.Popen([str(PROGRAM), "run", str(scene), "--view", "--port", "0", "--camera", "side", "--resolution", "320x240"],
                                        stderr=subprocess.PIPE, text=True, cwd=self.folder)
        self.addCleanup(self.end_program)
        url = None
        for line in self.program.stderr:
            if url := re.search(r"http://\S+", line):
                break
        self.assertIsNotNone(url, "the program prints no address")
        self.page = browser.Browser(1280, 800)
        self.addCleanup(self.page.close)
        self.page.open(url.group(0))
        self.page.wait("document.getElementById('placeholder')?.hidden")

    def end_program(self):
        if self.program.poll() is None:
            self.program.send_signal(signal.SIGINT)
            self.program.wait(20)
        self.program.stderr.close()

    def time(self):
        self.page.wait("!isNaN(parseFloat(document.getElementById('time').innerText))")  # a first picture may come before it
        return float(self.page.text("time").split()[0])

    def pull_to_the_right(self):
        box = self.page.value("(() => { const b = document.getElementById('stage').getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()")
        self.page.mouse("mousePressed", *box, ctrl=True)
        self.page.wait("document.getElementById('notice').innerText == 'Pulling ball'")
        for k in range(1, 6):
            self.page.mouse("mouseMoved", box[0] + 50 * k, box[1], ctrl=True)
        self.page.wait(f"(([left, right]) => right > 2 * left)({REDNESS})")
        self.page.mouse("mouseReleased", box[0] + 250, box[1], ctrl=True)

    def test_the_page_shows_and_drives_the_simulation(self):
        page = self.page
        left, right = page.value(REDNESS)
        self.assertGreater(left, 1, "the ball is not seen")
        self.assertAlmostEqual(left, right, delta=0.2 * left)
        self.assertNotIn("token", page.value("location.href"), "the secret stays in the address bar")
        start = self.time()
        page.wait(f"parseFloat(document.getElementById('time').innerText) > {start}")

        self.pull_to_the_right()
        page.wait(f"(([left, right]) => Math.abs(left - right) < 0.2 * left)({REDNESS})", 30)  # the spring brings it back

        page.key(" ", " ")
        page.wait("document.getElementById('factor').innerText == 'paused'")
        time.sleep(0.5)  # the page says so before the simulation has answered
        steps = int(page.text("steps").replace(",", ""))
        page.click("step")
        page.wait(f"document.getElementById('steps').innerText.replaceAll(',', '') == {steps + 1}")
        page.click("faster")
        page.wait("document.getElementById('speed').innerText == '2×'")
        page.click("reset")
        page.wait("document.getElementById('steps').innerText == '0'")

        page.resize(420, 800)
        outside = page.value("""[...document.querySelectorAll('button, select, dd, .link')].filter((e) => e.offsetParent !== null)
            .filter((e) => { const b = e.getBoundingClientRect(); return b.left < 0 || b.right > innerWidth || b.bottom > innerHeight; }).map((e) => e.id)""")
        self.assertEqual(outside, [], "does not fit on a narrow screen")
        self.assertEqual(page.problems, [])

        self.program.send_signal(signal.SIGINT)
        page.wait("document.getElementById('link-text').innerText == 'Ended'")
        self.assertEqual(self.program.wait(20), 0)


if __name__ == "__main__":
    unittest.main()
