"""The studio in Debian's Chromium, driven by Playwright."""
import os
import re
import shutil
import signal
import struct
import subprocess
import time

from playwright.sync_api import expect, sync_playwright

from e2e.support import PROGRAM, ProgramTest

SCENE = """<mujoco model="rig">
  <option timestep="0.002"/>
  <asset><mesh name="cube" vertex="-.2 -.2 -.2 .2 -.2 -.2 -.2 .2 -.2 .2 .2 -.2 -.2 -.2 .2 .2 -.2 .2 -.2 .2 .2 .2 .2 .2"/></asset>
  <visual><global offwidth="320" offheight="240"/></visual>
  <worldbody>
    <light pos="0 1 2.2" dir="0 -0.3 -1"/>
    <geom name="floor" type="plane" size="2 2 0.1" rgba=".5 .6 .5 1"/>
    <body name="cart" pos="0 0 1">
      <joint name="x" type="slide" axis="1 0 0" range="-1 1" limited="true" stiffness="40" damping="1"/>
      <geom name="cart" size="0.3" mass="1" rgba="0.8 0.2 0.2 1"/><site name="top" pos="0 0 .35"/>
    </body>
    <body name="box" pos="1 0 0.2"><freejoint name="free"/><geom name="box" type="mesh" mesh="cube" mass="2"/></body>
    <site name="anchor" pos="0 .5 2"/>
    <camera name="side" pos="0 -3 1" xyaxes="1 0 0 0 0 1"/>
  </worldbody>
  <tendon><spatial name="rope"><site site="anchor"/><site site="top"/></spatial></tendon>
  <equality><weld name="held" body1="box" active="false"/></equality>
  <actuator><motor name="push" joint="x" ctrlrange="-5 5"/></actuator>
  <sensor><jointpos name="place" joint="x"/></sensor>
  <keyframe><key name="aside" qpos="0.5 1 0 0.2 1 0 0 0" ctrl="1.5"/></keyframe>
</mujoco>
"""

# Mean red of the image in its left and right half: where the cart is, and that there is an image at all.
REDNESS = """() => {
  const canvas = document.getElementById("picture"), w = canvas.width, h = canvas.height;
  const copy = new OffscreenCanvas(w, h).getContext("2d", { willReadFrequently: true });
  copy.drawImage(canvas, 0, 0);
  const pixels = copy.getImageData(0, 0, w, h).data, sum = [0, 0];
  for (let i = 0; i < w * h; ++i) sum[i % w < w / 2 ? 0 : 1] += Math.max(0, pixels[4 * i] - pixels[4 * i + 1]);
  return sum.map((s) => s / (w * h));
}"""

# Pixels that the browser has drawn itself.
DRAWN = """() => {
  const canvas = document.getElementById("viewport");
  if (!canvas || !canvas.width) return 0;
  document.dispatchEvent(new Event("redraw_view"));
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
  copy.drawImage(canvas, 0, 0);
  const pixels = copy.getImageData(0, 0, canvas.width, canvas.height).data;
  let drawn = 0;
  for (let i = 3; i < pixels.length; i += 4) drawn += pixels[i] > 0;
  return drawn;
}"""

expect.set_options(timeout=20_000)  # the machine may be busy

SOFTWARE_GL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


class StudioTest(ProgramTest):
    """A program for each test, one browser for all."""

    ARGUMENTS = ("--camera", "side", "--resolution", "320x240")

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.playwright = sync_playwright().start()
        chromium = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
        if chromium is None:
            raise RuntimeError("there is no Chromium: ./gloam test installs it")
        cls.browser = cls.playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox", *SOFTWARE_GL])

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.playwright.stop()
        super().tearDownClass()

    def serve(self, *arguments):
        """Starts the program; returns the address that it prints."""
        self.program = subprocess.Popen([str(PROGRAM), *map(str, arguments)], stderr=subprocess.PIPE, text=True, cwd=self.folder,
                                        env={**os.environ, "DISPLAY": "", "WAYLAND_DISPLAY": ""})
        self.addCleanup(self.end_program)
        for line in self.program.stderr:
            if url := re.search(r"http://\S+", line):
                return url.group(0)
        return self.fail("the program prints no address")

    def end_program(self):
        if self.program.poll() is None:
            self.program.send_signal(signal.SIGINT)
            self.program.wait(20)
        self.program.stderr.close()

    def open_studio(self, *arguments, scene=SCENE):
        self.url = self.serve("studio", self.write("rig.xml", scene), "--port", "0", *self.ARGUMENTS, *arguments)
        self.page = self.open_page()
        return self.page

    def open_page(self, width=1440, height=900):
        """A page that shows an image. self.problems: complaints in its console; self.packets: kinds of images that came."""
        context = self.browser.new_context(viewport={"width": width, "height": height})
        context.set_default_timeout(30_000)
        self.addCleanup(context.close)
        page = context.new_page()
        self.problems, self.packets = [], []
        page.on("pageerror", lambda error: self.problems.append(str(error)))
        page.on("console", lambda message: self.problems.append(message.text) if message.type in ("error", "warning") else None)
        page.on("websocket", lambda socket: socket.on("framereceived", self.note_packet))
        page.goto(self.url)
        self.wait("document.getElementById('picture')?.width > 4", page=page)
        return page

    def wait(self, expression, page=None, seconds=30, arg=None):
        """Until an expression of the page is true. (Playwright's own wait needs eval(), which the page's policy forbids.)"""
        page = page or self.page
        deadline = time.monotonic() + seconds
        while not page.evaluate(expression, arg):
            self.assertLess(time.monotonic(), deadline, f"never true: {expression}")
            page.wait_for_timeout(50)

    def note_packet(self, payload):
        if isinstance(payload, bytes) and payload[:4] == b"GLV1":
            self.packets.append("h264" if struct.unpack_from("<I", payload, 40)[0] & 2 else "jpeg")

    def text(self, element):
        return self.page.locator(f"#{element}").inner_text()

    def steps(self):
        return int(self.text("steps").replace(",", ""))

    def wait_for_steps(self, steps):
        expect(self.page.locator("#steps")).to_have_text(f"{steps:,}")

    def open_section(self, title):
        fold = self.page.get_by_role("button", name=title, exact=True)
        if fold.get_attribute("aria-expanded") == "false":
            fold.click()
        return self.page.get_by_test_id("section-" + re.sub(r"\W+", "-", title.lower()))

    def check_console(self):
        """WebGL in software is slow, and Chromium warns of that; everything else is a fault of the page."""
        self.assertEqual([text for text in self.problems if "GPU stall" not in text and "GL Driver Message" not in text], [])
