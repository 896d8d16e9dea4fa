"""The studio in a real browser: playback, panels, keys, overlays, spectators, accessibility."""
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from axe_core_python.sync_playwright import Axe
from playwright.sync_api import expect

from e2e.studio_page import DRAWN, REDNESS, SCENE, StudioTest
from e2e.support import PROGRAM, ROOT

SECTIONS = ["Physics", "Visualization", "Group enable", "Drive", "Keyframes", "Joints", "Control", "Equality", "Sensors", "Contacts", "Watch",
            "Plots", "Profiler"]
SWITCHES = ["Tab", "Shift + Tab", "F1", "?", "F2", "W"]


class Playback(StudioTest):
    def test_plays_steps_back_and_forth_and_resets(self):
        page = self.open_studio()
        left, right = page.evaluate(REDNESS)
        self.assertGreater(left, 1, "the cart is not seen")
        self.assertAlmostEqual(left, right, delta=0.2 * left)
        self.assertNotIn("token", page.url, "the secret stays in the address bar")
        self.assertEqual(self.steps(), 0)
        page.keyboard.press("Space")
        self.wait("parseFloat(document.getElementById('time').innerText) > 0.3")
        page.keyboard.press("Space")
        expect(page.locator("#factor")).to_have_text("paused")
        page.wait_for_timeout(400)  # the page shows it before the simulation has answered
        steps, state = self.steps(), self.text("hash")
        page.click("#step")
        self.wait_for_steps(steps + 1)
        page.keyboard.press("Shift+ArrowRight")
        self.wait_for_steps(steps + 11)
        page.keyboard.press("ArrowLeft")
        self.wait_for_steps(steps + 10)
        page.keyboard.press("Shift+ArrowLeft")
        self.wait_for_steps(steps)
        expect(page.locator("#hash")).to_have_text(state)  # bit for bit
        page.click("#faster")
        expect(page.locator("#speed")).to_have_text("2×")
        page.click("#reset")
        self.wait_for_steps(0)
        self.check_console()
        self.program.send_signal(signal.SIGINT)
        expect(page.locator("#link-text")).to_have_text("Ended")
        self.assertEqual(self.program.wait(20), 0)

    def test_a_body_is_pulled_by_the_mouse(self):
        page = self.open_studio("--play")
        box = page.locator("#stage").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.keyboard.down("Control")
        page.mouse.move(x, y)
        page.mouse.down(button="right")
        expect(page.locator("#notice")).to_have_text("Pulling cart")
        page.mouse.move(x + 250, y, steps=5)
        self.wait(f"(([left, right]) => right > 2 * left)(({REDNESS})())")
        page.mouse.up(button="right")
        page.keyboard.up("Control")
        self.wait(f"(([left, right]) => Math.abs(left - right) < 0.2 * left)(({REDNESS})())", seconds=30)  # the spring
        self.check_console()

    def test_images_come_as_video_where_the_browser_decodes_it(self):
        page = self.open_studio("--play")
        if not page.evaluate("typeof VideoDecoder !== 'undefined'"):
            self.skipTest("this Chromium has no WebCodecs")
        deadline = time.monotonic() + 60
        while self.packets.count("h264") < 6:  # each is acknowledged after it is drawn
            self.assertLess(time.monotonic(), deadline, f"no video: {self.packets}")
            page.wait_for_timeout(100)
        self.assertEqual(self.packets[-1], "h264", "the decoder failed")
        left, right = page.evaluate(REDNESS)
        self.assertGreater(left, 1, "the cart is not seen in the video")
        self.check_console()

    def test_a_log_is_opened_and_scrubbed(self):
        scene = self.write("rig.xml", SCENE)
        log = self.folder / "run.mcap"
        done = subprocess.run([str(PROGRAM), "record", str(scene), "-o", str(log), "--duration", "2", "--topics", "/clock"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.url = self.serve("studio", log, "--port", "0", "--resolution", "160x120")
        page = self.page = self.open_page()
        expect(page.locator("#end")).to_have_text("2.00 s")
        for instant in (1.5, 0.5):
            page.evaluate("""(t) => { const seek = document.getElementById('seek'); seek.value = t; seek.dispatchEvent(new Event('input', {bubbles: true})); }""", instant)
            expect(page.locator("#time")).to_have_text(f"{instant:.3f} s")
        self.check_console()


class Panels(StudioTest):
    def test_every_section_opens_without_a_complaint(self):
        page = self.open_studio("--play")
        for title in SECTIONS:
            self.open_section(title)
        page.wait_for_timeout(1500)
        self.assertEqual(page.locator(".fold[aria-expanded=true]").count(), len(SECTIONS))
        expect(self.open_section("Physics")).to_contain_text("-9.81 m/s²")
        expect(self.open_section("Contacts")).to_contain_text("world – box")
        self.assertGreaterEqual(page.locator(".plot canvas").count(), 4)
        self.check_console()

    def test_joints_are_posed_while_paused(self):
        page = self.open_studio()
        joint = self.open_section("Joints").get_by_test_id("joint-0").locator("input[type=number]")
        joint.fill("0.8")
        joint.press("Enter")
        self.wait(f"(([left, right]) => right > 2 * left)(({REDNESS})())")
        self.assertEqual(self.steps(), 0)
        joint.fill("7")  # out of range: rejected in the field
        joint.press("Enter")
        expect(joint).to_have_value("0.800")
        page.keyboard.press("Escape")
        page.locator("#stage").focus()
        page.keyboard.press("ArrowRight")
        self.wait_for_steps(1)
        expect(self.open_section("Sensors").get_by_test_id("sensor-0")).to_have_text("0.800")
        self.check_console()

    def test_a_number_is_typed_while_the_simulation_changes_it(self):
        page = self.open_studio("--play")
        field = self.open_section("Joints").get_by_test_id("joint-1").locator("input").nth(0)  # x of the free box
        field.click()
        field.press("Control+a")
        for key in "1.25":
            field.press(key)
            page.wait_for_timeout(150)  # several states
        expect(field).to_have_value("1.25")
        field.press("Enter")
        expect(field).to_have_value("1.250")
        self.check_console()

    def test_controls_constraints_and_keyframes(self):
        page = self.open_studio()
        control = self.open_section("Control").get_by_test_id("control-0").locator("input[type=number]")
        control.fill("-2.5")
        control.press("Enter")
        expect(control).to_have_value("-2.500")
        page.click("#clear-controls")
        expect(control).to_have_value("0.000")
        self.open_section("Equality")
        page.click("#equality-0")
        self.wait("document.getElementById('equality-0').checked")
        self.open_section("Keyframes").get_by_test_id("load-keyframe-0").click()
        expect(control).to_have_value("1.500")
        joint = self.open_section("Joints").get_by_test_id("joint-0").locator("input[type=number]")
        expect(joint).to_have_value("0.500")
        page.click("#save-state")
        page.click("#reset")
        expect(joint).to_have_value("0.000")
        page.get_by_test_id("section-keyframes").get_by_role("button", name="Load", exact=True).nth(1).click()
        expect(joint).to_have_value("0.500")
        self.check_console()

    def test_any_number_of_mujoco_is_watched(self):
        page = self.open_studio()
        self.open_section("Watch")
        page.fill("#watch-field", "opt.gravity")
        page.fill("#watch-index", "2")
        page.click("#watch-add")
        expect(page.get_by_test_id("watch-0")).to_have_text("-9.81000")
        page.fill("#watch-field", "nonsense")
        page.click("#watch-add")
        expect(page.locator("#notice")).to_contain_text("nonsense")
        self.check_console()


class View(StudioTest):
    def test_every_overlay_draws(self):
        page = self.open_studio("--play")
        self.wait("parseFloat(document.getElementById('time').innerText) > 0.5")  # the box rests on the floor
        page.locator("#stage").dblclick()
        expect(page.locator("#selected")).to_contain_text("cart")
        overlays = page.locator("input[id^=overlay-]")
        self.assertGreaterEqual(overlays.count(), 17)
        for i in range(overlays.count()):
            name = overlays.nth(i).get_attribute("id")
            if name in ("overlay-labels", "overlay-cameras"):  # texts have a canvas of their own; the camera does not see itself
                continue
            with self.subTest(name):
                overlays.nth(i).check()
                self.wait(f"({DRAWN})() > 20")
                overlays.nth(i).uncheck()
        self.check_console()

    def test_the_browser_draws_the_scene_itself(self):
        page = self.open_studio()
        page.keyboard.press("w")
        self.wait(f"({DRAWN})() > 20000")
        box = page.locator("#stage").bounding_box()
        for x in range(10, 100, 4):  # along the floor in front of the camera, which the mesh stands on
            page.mouse.dblclick(box["x"] + x / 100 * box["width"], box["y"] + 0.8 * box["height"])
            if page.locator("#selected").count() and "box" in self.text("selected"):
                break
        else:
            self.fail("the mesh is not drawn")
        box = page.locator("#stage").bounding_box()
        page.mouse.move(box["x"] + 200, box["y"] + 200)
        page.mouse.down()
        page.mouse.move(box["x"] + 400, box["y"] + 250, steps=4)
        page.mouse.up()
        self.wait(f"({DRAWN})() > 20000")
        page.keyboard.press("w")
        expect(page.locator("#viewport")).to_have_count(0)
        self.check_console()

    def test_the_free_camera_orbits_zooms_and_follows(self):
        page = self.open_studio()
        page.keyboard.press("Escape")
        expect(page.locator("#camera")).to_have_value("free")
        page.keyboard.press("F2")
        place = lambda: next(line for line in self.text("info").splitlines() if line.startswith("position"))  # noqa: E731
        self.wait("document.getElementById('info')?.innerText.includes('position')")
        for act in (lambda: self.drag(100, 0), lambda: page.mouse.wheel(0, -300), lambda: self.drag(60, 40, button="right")):
            before = place()
            act()
            self.wait("(before) => !document.getElementById('info').innerText.includes(before)", arg=before)
        self.check_console()

    def drag(self, dx, dy, button="left"):
        box = self.page.locator("#stage").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        self.page.mouse.move(x, y)
        self.page.mouse.down(button=button)
        self.page.mouse.move(x + dx, y + dy, steps=4)
        self.page.mouse.up(button=button)


class Keys(StudioTest):
    def test_every_key_of_the_list_acts(self):
        page = self.open_studio()
        page.evaluate("() => { HTMLElement.prototype.requestFullscreen = function () { document.title = 'full screen'; return Promise.resolve(); }; }")
        page.keyboard.press("F1")
        keys = [text for row in page.locator("#help table:not(.mouse) kbd").all_inner_texts() for text in row.split(", ")]
        self.assertGreater(len(keys), 40)
        page.keyboard.press("F1")
        expect(page.locator("#help")).not_to_be_visible()
        signature = """() => JSON.stringify([document.title, document.body.innerText, document.getElementById('camera').value,
            [...document.querySelectorAll('input')].map((e) => e.type == 'checkbox' ? e.checked : e.value),
            [...document.querySelectorAll('[aria-pressed], [aria-expanded]')].map((e) => [e.ariaPressed, e.ariaExpanded])])"""
        for title in ("Group enable", "Keyframes"):
            self.open_section(title)
        page.keyboard.press("Shift+ArrowRight")
        self.wait_for_steps(10)
        names = {"Space": "Space", "←": "ArrowLeft", "→": "ArrowRight", "Esc": "Escape", "−": "-"}
        for key in keys:
            with self.subTest(key):
                page.locator("#stage").focus()
                page.wait_for_timeout(150)
                before = page.evaluate(signature)
                downloads = []
                page.on("download", lambda download: downloads.append(download))
                press = "+".join(names.get(part, part.lower() if len(part) == 1 else part) for part in key.split(" + ")).replace("Ctrl", "Control")
                page.keyboard.press(press)
                for _ in range(40):
                    if downloads or page.evaluate(signature) != before:
                        break
                    page.wait_for_timeout(50)
                else:
                    self.fail(f"{key} has no effect")
                if key in SWITCHES:  # the panels show the effects of the other keys
                    page.keyboard.press(press)
        self.check_console()


class Clients(StudioTest):
    def test_one_controls_and_others_watch(self):
        first = self.open_studio()
        second = self.open_page()
        expect(second.locator("#role")).to_have_text("Watching")
        expect(second.locator("#play")).to_be_disabled()
        self.assertIn("in control", second.locator("#play").get_attribute("title"))
        second.click("#claim")
        expect(second.locator("#play")).to_be_enabled()
        expect(first.locator("#play")).to_be_disabled()
        second.reload()
        expect(second.locator("#link-text")).to_have_text("Connected")
        self.check_console()

    def test_a_phone_can_watch(self):
        self.open_studio()
        page = self.open_page(390, 800)
        page.wait_for_timeout(500)
        outside = page.evaluate("""[...document.querySelectorAll('.bar button, select, .status dd, .link')].filter((e) => e.offsetParent !== null)
            .filter((e) => { const b = e.getBoundingClientRect(); return b.left < 0 || b.right > innerWidth || b.bottom > innerHeight; }).map((e) => e.id)""")
        self.assertEqual(outside, [])

    def test_accessible_in_both_themes(self):
        page = self.open_studio()
        for title in SECTIONS:
            self.open_section(title)
        for theme in ("dark", "light"):
            page.emulate_media(color_scheme=theme)
            page.wait_for_timeout(300)
            found = Axe().run(page)["violations"]
            serious = [f"{each['id']}: {[node['html'][:160] for node in each['nodes']][:3]}" for each in found if each["impact"] in ("serious", "critical")]
            self.assertEqual(serious, [], theme)


class Bundle(unittest.TestCase):
    @unittest.skipUnless(shutil.which("npm"), "only developers of the page need Node")
    def test_the_bundle_is_that_of_the_sources(self):
        with tempfile.TemporaryDirectory(prefix="gloam_studio_") as scratch:
            copy = Path(scratch) / "studio"
            shutil.copytree(ROOT / "studio", copy, ignore=shutil.ignore_patterns("node_modules", "bundle"))
            for command in (["npm", "ci", "--no-audit", "--no-fund"], ["npm", "run", "build"]):
                done = subprocess.run(command, cwd=copy, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            files = {path.name: path.read_bytes() for path in (copy / "bundle").iterdir()}
            shipped = {path.name: path.read_bytes() for path in (ROOT / "studio" / "bundle").iterdir()}
            self.assertEqual(sorted(files), sorted(shipped))
            self.assertEqual([name for name in files if files[name] != shipped[name]], [], "run npm run build in studio/ and commit the bundle")


if __name__ == "__main__":
    unittest.main()
