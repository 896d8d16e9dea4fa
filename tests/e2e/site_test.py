"""./gloam docs builds a site whose links and anchors resolve, which can be searched, and which requests nothing from other hosts."""
import json
import re
import subprocess
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit
from urllib.request import urlopen

from e2e.support import ROOT

sys.path.insert(0, str(ROOT / "tools" / "docs"))
import docs  # noqa: E402


class Page(HTMLParser):
    """Anchors of a page, its links, and the files that a browser loads with it."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.loaded = set(), [], []
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors |= {values[name] for name in ("id", "name") if values.get(name)}
        if tag == "a" and values.get("href"):
            self.links.append(values["href"])
        elif tag == "link" and values.get("rel") not in ("canonical", "next", "prev"):
            self.loaded.append(values["href"])
        self.loaded += [values[name] for name in ("src", "data", "poster") if values.get(name)]


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        (ROOT / "build").mkdir(exist_ok=True)
        scratch = tempfile.TemporaryDirectory(prefix="site_test_", dir=ROOT / "build")
        cls.addClassCleanup(scratch.cleanup)
        cls.site = Path(scratch.name) / "site"
        process = subprocess.Popen([ROOT / "gloam", "docs", "--out", cls.site, "--serve", "--port", "0"], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        cls.addClassCleanup(process.communicate)
        cls.addClassCleanup(process.terminate)
        output, cls.address = "", None
        while cls.address is None:
            line = process.stdout.readline()
            output += line
            if found := re.search(r"http://127\.0\.0\.1:\d+/", line):
                cls.address = found.group(0)
            elif not line:
                raise AssertionError(output)
        cls.pages = {path.resolve(): Page(path) for path in cls.site.rglob("*.html") if path.name != "404.html"}

    def test_it_is_served_on_this_machine(self):
        with urlopen(self.address + "docs/light.html") as response:
            self.assertIn(b"<title>Light", response.read())

    def test_every_link_and_anchor_resolves(self):
        bad = []
        for path, page in self.pages.items():
            for link in page.links + page.loaded:
                parts = urlsplit(link)
                if parts.scheme or parts.netloc:
                    continue
                target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
                if target.is_dir():
                    target /= "index.html"
                anchor = unquote(parts.fragment)
                if not target.exists() or (anchor and target in self.pages and anchor not in self.pages[target].anchors):
                    bad.append(f"{path.relative_to(self.site)}: {link}")
        self.assertEqual(bad, [])

    def test_pages_load_nothing_from_other_hosts(self):
        outside = [f"{path.relative_to(self.site)}: {link}" for path, page in self.pages.items() for link in page.loaded
                   if urlsplit(link).scheme not in ("", "data") or urlsplit(link).netloc]
        for path in self.site.rglob("*.css"):
            outside += [f"{path.name}: {link}" for link in re.findall(r"""(?:url\(|@import )["']?((?:https?:)?//[^"')]+)""", path.read_text())]
        self.assertEqual(outside, [])
        # Material's script loads these from a CDN, but only on pages that use them.
        for path in self.pages:
            self.assertNotRegex(path.read_text(), r'class="(mermaid|arithmatex)"|data-md-component="source"', path.name)

    def test_the_search_index_covers_guides_and_references(self):
        index = json.loads((self.site / "search" / "search_index.json").read_text())
        texts = {entry["location"]: entry["text"] for entry in index["docs"]}
        pages = {location.split("#")[0] for location in texts}
        for guide in (ROOT / "docs").glob("*.md"):
            self.assertIn(f"docs/{'index' if guide.stem == 'README' else guide.stem}.html", pages)
        for header in (ROOT / "include" / "gloam").rglob("*.h"):
            self.assertIn(f"api/cpp/{header.relative_to(ROOT / 'include' / 'gloam').with_suffix('.html')}", pages)
        self.assertTrue(any("sim.run_until" in text for text in texts.values()))
        titles = [entry["title"] for entry in index["docs"] if "#" not in entry["location"]]
        self.assertEqual({title for title in titles if titles.count(title) > 1}, set(), "pages that a search cannot tell apart")

    def test_references_show_signatures_and_comments(self):
        cpp = (self.site / "api/cpp/camera.html").read_text()
        self.assertIn('id="intrinsics"', cpp)
        self.assertRegex(cpp, r'href="types\.html#pose"')
        self.assertRegex(re.sub(r"<[^>]+>", "", cpp), r"double fx = 0, fy = 0;\s*focal lengths \[px\]")
        python = re.sub(r"<[^>]+>", "", (self.site / "api/python/simulation.html").read_text())
        self.assertRegex(python, r"step_until\(")

    def test_nothing_of_a_private_part_of_a_class_is_shown(self):
        self.assertNotIn("value_", re.sub(r"<[^>]+>", "", (self.site / "api/cpp/result.html").read_text()))


class Strictness(unittest.TestCase):
    def test_broken_links_and_pages_outside_the_index_are_errors(self):
        docs.install()
        for fault, words in [("see [that](no_such_page.md)", "no_such_page.md"), ("see [that](water.md#no-such-part)", "no-such-part")]:
            with tempfile.TemporaryDirectory() as scratch:
                pages = Path(scratch) / "pages"
                docs.gather(pages, Path(scratch) / "site")
                for path in (pages / "site").rglob("*.md"):  # two pages are enough, and quick
                    if path.name not in ("wind.md", "water.md") or "gallery" in path.parts:
                        path.unlink()
                (pages / "site/docs/wind.md").write_text(f"# Wind\n\n{fault}\n")
                (pages / "site/docs/water.md").write_text("# Water\n")
                settings = (pages / "mkdocs.yml").read_text().splitlines()
                nav = 'nav: ["docs/wind.md", "docs/water.md"]'
                (pages / "mkdocs.yml").write_text("\n".join([line for line in settings if not line.startswith("nav:")] + [nav]))
                with self.assertRaises(ValueError) as raised:
                    docs.build(pages)
                self.assertIn(words, str(raised.exception))


class Headers(unittest.TestCase):
    """The parser of public headers."""

    def parse(self, text):
        import headers
        return headers.parse("#pragma once\n// Introduction.\n\n#include <x>\n\nnamespace gloam {\n\n" + text + "\n}  // namespace gloam\n")

    def test_of_types_and_members(self):
        introduction, (thing,) = self.parse("/// A thing.\nstruct Thing {\n  int a = 0;  ///< [m]\n              ///< of more\n  /// Sum.\n"
                                            "  int sum(int b) const { return a + b; }\n  enum class Kind { kA, kB };\n};")
        self.assertEqual(introduction, "Introduction.")
        self.assertEqual((thing.code, thing.text, thing.name), ("struct Thing", "A thing.", "Thing"))
        self.assertEqual([(member.code, member.text) for member in thing.members],
                         [("int a = 0;", "[m]\nof more"), ("int sum(int b) const;", "Sum."), ("enum class Kind { kA, kB };", "")])

    def test_of_enumerators(self):
        _, (kind,) = self.parse("enum class Kind : uint8_t {\n  kA,  ///< first\n  kLonger,  ///< second,\n           ///< and more\n};")
        self.assertEqual([(member.code, member.text) for member in kind.members], [("kA", "first"), ("kLonger", "second,\nand more")])

    def test_of_classes_and_templates(self):
        _, declarations = self.parse("/// A value.\ntemplate <class T>\nclass Result {\n"
                                     " public:\n  Result(T v) : v_(v) {}\n\n private:\n  T v_;\n};\n"
                                     "/// Doubles.\n"
                                     "int twice(int a,\n          int b = 2);\ninline constexpr int kMost = 3;  ///< [1]")
        self.assertEqual([d.name for d in declarations], ["Result", "twice", "kMost"])
        self.assertEqual([member.code for member in declarations[0].members], ["Result(T v);"])
        self.assertEqual(declarations[2].text, "[1]")

    def test_details_are_left_out(self):
        _, declarations = self.parse("struct Other;  // elsewhere\nstatic_assert(sizeof(int) == 4);\n#define HELPER(a) a\n"
                                     "/// Tries.\n#define TRY(a) \\\n  HELPER(a)\ninline constexpr auto kSizes = [] {\n  return f(1);\n}();")
        self.assertEqual([(d.name, d.text) for d in declarations], [("TRY", "Tries."), ("kSizes", "")])

    def test_every_declaration_of_the_public_headers_has_a_name(self):
        import headers
        for path in (ROOT / "include").rglob("*.h"):
            for declaration in headers.parse(path.read_text())[1]:
                if declaration.code:
                    self.assertRegex(declaration.name, r"^[A-Za-z_~]\w*$|^operator", f"{path.name}: {declaration.code}")


if __name__ == "__main__":
    unittest.main()
