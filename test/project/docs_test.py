#!/usr/bin/env python3
"""The docs: links lead somewhere, every page and picture is linked, the README is short, the version is one."""
import importlib.machinery
import importlib.util
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "models/README.md", ROOT / "bench/results/README.md",
         *sorted((ROOT / "docs").rglob("*.md"))]


def anchors(page):
    """As GitHub makes them: lower case, without punctuation, hyphens for spaces."""
    titles = re.findall(r"^#+ (.*)$", page.read_text(), re.M)
    return {re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-") for title in titles}


def links(page):
    """(text of the link, file, anchor) of all links into this tree."""
    for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
        if "://" not in link:
            path, _, anchor = link.partition("#")
            yield link, (page.parent / path).resolve() if path else page, anchor


# Words that these pages used in a private sense, and the field's terms. request.md is made from descriptions of keys.
INSTEAD = {"tell": "state", "tells": "states", "told": "stated", "grip": "friction scale", "middle": "centre",
           "shade": "occlusion", "rubs": "slides", "foretell": "predict", "foretold": "predicted",
           "lately": "recently"}
WRITTEN = [page for page in PAGES if page.name != "request.md"]


def running_text(page):
    """Without code."""
    return re.sub(r"^```.*?^```|^    .*?$|`[^`\n]*`", "", page.read_text(), flags=re.M | re.S)


class Docs(unittest.TestCase):
    def test_links_lead_somewhere(self):
        for page in PAGES:
            for link, target, anchor in links(page):
                with self.subTest(page=page.relative_to(ROOT).as_posix(), link=link):
                    self.assertTrue(target.exists(), "no such file")
                    if anchor:
                        self.assertIn(anchor, anchors(target))

    def test_every_page_and_picture_is_linked(self):
        linked = {target for page in PAGES for _, target, _ in links(page)}
        for path in (ROOT / "docs").rglob("*.*"):
            self.assertIn(path, linked, "nothing leads to it")

    def test_the_readme_is_read_in_a_few_minutes(self):
        """The only page with a limit: a reader decides there whether this is the tool for the job."""
        self.assertLess(len((ROOT / "README.md").read_text().split()), 1500, "details belong in docs/")

    def test_words_are_those_of_the_field(self):
        for page in WRITTEN:
            for word in re.findall(r"[a-z]+", running_text(page).lower()):
                with self.subTest(page=page.relative_to(ROOT).as_posix()):
                    self.assertNotIn(word, INSTEAD, "write: " + INSTEAD.get(word, ""))

    def test_a_finding_answers_in_its_first_two_lines(self):
        for page in (ROOT / "docs/lab/findings").glob("*.md"):
            if page.name != "README.md":
                title, *answer = page.read_text().splitlines()[:3]
                self.assertTrue(title.startswith("# ") and title.endswith("?"), page.name)
                self.assertTrue(all(line.endswith(".") for line in answer), page.name)

    def test_every_header_begins_with_sentences(self):
        """Two sentences at least where others include it, one elsewhere; the first comment of the file counts."""
        for folder, least in (("include", 2), ("src", 1)):
            for path in sorted((ROOT / folder).rglob("*.hpp")):
                first = re.match(r"(?:///? ?.*\n)*", path.read_text())[0]
                ends = len(re.findall(r"[.!?:](?=\s|$)", first))
                with self.subTest(header=path.relative_to(ROOT).as_posix()):
                    self.assertGreaterEqual(ends, least)

    def test_sentences_are_drawn_by_seed(self):
        script = ROOT / "scripts/draw_sentences"
        loader = importlib.machinery.SourceFileLoader("draw_sentences", str(script))
        draw = importlib.util.module_from_spec(importlib.util.spec_from_loader("draw_sentences", loader))
        loader.exec_module(draw)
        lines = ["/// Of two", "/// lines. And more.", "int a;  ///< of a,", "        ///< continued", "/// Next.", "", "// x y"]
        self.assertEqual(list(draw.comments(lines)),
                         [(1, "Of two lines. And more."), (3, "`int a;` of a, continued"), (5, "Next."), (7, "x y")])
        lines = ["# Title", "A line. Another.", "```", "code", "```", "| a | b |", "- an item"]
        self.assertEqual(list(draw.markdown(lines)), [(2, "A line. Another."), (7, "an item")])

        def drawn(*options):
            return subprocess.run([script, *options], capture_output=True, text=True, check=True).stdout.splitlines()
        self.assertEqual(drawn("--seed", "1"), drawn("--seed", "1"))
        self.assertNotEqual(drawn("--seed", "1"), drawn("--seed", "2"))
        self.assertEqual(len(drawn("--seed", "3", "-n", "50")), 50)

    def test_the_version_is_one(self):
        version = re.search(r"project\(bin_scenes VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertIn("<version>%s</version>" % version, (ROOT / "package.xml").read_text())
        newest = re.search(r"^([\d.]+) \(\d{4}-\d\d-\d\d\)$", (ROOT / "CHANGELOG.rst").read_text(), re.M)
        self.assertEqual(newest and newest[1], version)
        citation = (ROOT / "CITATION.cff").read_text()
        released = re.search(r"^%s \(([\d-]+)\)$" % re.escape(version), (ROOT / "CHANGELOG.rst").read_text(), re.M)
        self.assertIn("version: %s\ndate-released: %s\n" % (version, released[1]), citation)


if __name__ == "__main__":
    unittest.main()
