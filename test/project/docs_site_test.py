#!/usr/bin/env python3
"""scripts/docs: the site builds without a warning, its links lead somewhere, and it needs no network."""
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import time
import unittest
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
CHROMIUM = shutil.which("chromium")


class Page(html.parser.HTMLParser):
    """The anchors of a page, its links, and the files that a browser loads to show it."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.loaded = {"", "top"}, set(), set()
        self.feed(path.read_text(encoding="utf-8", errors="replace"))

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors |= {values[k] for k in ("id", "name") if values.get(k)}
        if tag == "a" and values.get("href"):
            self.links.add(values["href"])
        if tag in ("img", "script") and values.get("src"):
            self.loaded.add(values["src"])
        if tag == "link" and values.get("rel") in ("stylesheet", "icon", "preconnect"):
            self.loaded.add(values["href"])


class Browser:
    """A page in Chromium, which is asked through its pipe: with virtual time it would not wait for a worker."""

    def __init__(self, url):
        self.home = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        asks, self.asks = os.pipe()
        self.answers, answers = os.pipe()
        self.process = subprocess.Popen(
            ["bash", "-c", 'exec "$@" 3<&%d 4>&%d' % (asks, answers), "-", CHROMIUM, "--headless", "--no-sandbox",
             "--disable-gpu", "--remote-debugging-pipe", "--user-data-dir=" + self.home.name, "about:blank"],
            env={**os.environ, "HOME": self.home.name}, pass_fds=(asks, answers), stderr=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL)
        os.close(asks)
        os.close(answers)
        self.number, self.buffer, self.session = 0, b"", {}
        target = self.ask("Target.createTarget", url=url)["targetId"]
        self.session = {"sessionId": self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        os.close(self.asks)
        os.close(self.answers)
        self.home.cleanup()

    def ask(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters, **self.session}
        os.write(self.asks, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.buffer:
                more = os.read(self.answers, 65536)
                if not more:
                    raise AssertionError("the browser ended")
                self.buffer += more
            answer, _, self.buffer = self.buffer.partition(b"\0")
            answer = json.loads(answer)
            if answer.get("id") == self.number:
                return answer["result"]

    def wait_for(self, expression):
        """The value of a list of JavaScript as soon as it is not empty; empty after minutes."""
        for _ in range(600):
            value = self.ask("Runtime.evaluate", expression=expression, returnByValue=True)["result"].get("value")
            if value:
                return value
            time.sleep(0.2)
        return []


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.run_ = subprocess.run([ROOT / "scripts/docs", cls.folder.name], text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT)
        cls.site = pathlib.Path(cls.folder.name).resolve() / "site"
        cls.pages = {path: Page(path) for path in cls.site.rglob("*.html")}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_it_builds_without_a_warning(self):
        self.assertEqual(self.run_.returncode, 0, self.run_.stdout)
        self.assertEqual(self.run_.stdout, "%s\n" % (self.site / "index.html"))

    def test_a_broken_link_ends_the_build(self):
        with tempfile.TemporaryDirectory() as name:
            copy = pathlib.Path(name) / "tree"
            shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(".git", "build*", "devel", "demo_out"))
            page = copy / "docs/use/start.md"
            page.write_text(page.read_text() + "\n[nowhere](nowhere.md)\n")
            run = subprocess.run([copy / "scripts/docs", copy / "out"], stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, text=True)
            self.assertEqual(run.returncode, 1)
            self.assertIn("nowhere.md", run.stdout)
            self.assertFalse((copy / "out/site").exists())

    def test_links_lead_somewhere(self):
        self.assertGreater(len(self.pages), 40)
        checked = 0
        for path, page in self.pages.items():
            by_doxygen = "api/cpp/" in path.as_posix()
            for link in page.links | page.loaded:
                url = urllib.parse.urlsplit(link)
                # Doxygen 1.9.4 links a section of a page's own summary that it leaves out.
                if url.scheme or url.netloc or (by_doxygen and link == "#nested-classes"):
                    continue
                target = (path.parent / urllib.parse.unquote(url.path)).resolve() if url.path else path
                if target.is_dir():
                    target = target / "index.html"
                checked += 1
                with self.subTest(page=path.relative_to(self.site).as_posix(), link=link):
                    self.assertTrue(target.exists(), "no such file")
                    if url.fragment and target in self.pages:
                        self.assertIn(urllib.parse.unquote(url.fragment), self.pages[target].anchors)
        self.assertGreater(checked, 1000)

    def test_no_page_loads_anything_from_the_network(self):
        for path, page in self.pages.items():
            for link in page.loaded:
                with self.subTest(page=path.relative_to(self.site).as_posix(), link=link):
                    self.assertFalse(urllib.parse.urlsplit(link).netloc)
        for path in self.site.rglob("*.css"):
            self.assertEqual(re.findall(r"url\([\"']?(https?:[^)]*)", path.read_text()), [], path)

    def test_the_references_are_there(self):
        classes = (self.site / "api/cpp/annotated.html").read_text()
        for name in ("Heap", "Solver", "SensorModel", "Generator"):
            self.assertIn(">%s<" % name, classes)
        python = (self.site / "api/python.html").read_text()
        for name in ("Generator", "Heap", "Scene", "Shards"):
            self.assertIn('<h2 id="%s"' % name.lower(), python)

    @unittest.skipUnless(CHROMIUM, "needs Debian's package chromium")
    def test_the_search_works_without_a_server(self):
        with Browser("%s?q=restitution" % (self.site / "index.html").as_uri()) as browser:
            links = browser.wait_for("Array.from(document.querySelectorAll('.md-search-result__link'), a => a.href)")
        self.assertTrue(any("docs/use/request.html" in link for link in links), links)


if __name__ == "__main__":
    unittest.main()
