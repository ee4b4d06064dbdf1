#!/usr/bin/env python3
"""The JSON schema of requests, by a validator of others: python3-jsonschema.

    json_schema_test.py TOOL
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import jsonschema
import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TOOL = ""


class Loader(yaml.SafeLoader):
    """YAML 1.2, as editors read it: 1e-3 is a number."""


Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"[-+]?\d+(\.\d*)?[eE][-+]?\d+$"), list("-+0123456789"))

BOLT = "{model: %s, unit: mm}" % (ROOT / "models/bolt_hex.stl")
WRONG = {  # request -> path of the key that is wrong
    "parts: [%s]\nsed: 7" % BOLT: "",
    "seed: 7": "",
    "parts: [{unit: mm}]": "parts/0",
    "parts: [{model: a.stl, unit: foot}]": "parts/0/unit",
    "parts: [{model: a.stl, count: 1.5}]": "parts/0/count",
    "parts: [{model: a.stl, friction: -0.1}]": "parts/0/friction",
    "parts: [{model: a.stl, scale: 0}]": "parts/0/scale",
    "parts: [{model: a.stl, poses: [[0, 0]]}]": "parts/0/poses/0",
    "parts: [{model: a.stl, surface: {albedo: 1.5}}]": "parts/0/surface/albedo",
    "parts: [%s]\nbin: {inner_size: [0.1, 0.1]}" % BOLT: "bin/inner_size",
    "parts: [%s]\nbin: {inner_size: [0.1, 0.1, 0]}" % BOLT: "bin/inner_size/2",
    "parts: [%s]\nsolver: {type: newton}" % BOLT: "solver/type",
    "parts: [%s]\nsensors: [{model: sonar}]" % BOLT: "sensors/0/model",
    "parts: [%s]\nsensors: [{stereo: {window: seven}}]" % BOLT: "sensors/0/stereo/window",
    "parts: [%s]\ngrippers: [7]" % BOLT: "grippers/0",
    "parts: [%s]\npour: {pattern: rain, hight: 1}" % BOLT: "pour",
}


class JsonSchema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        text = subprocess.run([TOOL, "reference", "--json-schema"], check=True, stdout=subprocess.PIPE).stdout
        cls.schema = json.loads(text)
        cls.validator = jsonschema.Draft7Validator(cls.schema)

    def test_is_a_schema(self):
        jsonschema.Draft7Validator.check_schema(self.schema)

    def test_takes_every_request_of_the_package(self):
        paths = [p for p in ROOT.glob("config/*.yaml") if "_plan" not in p.name]
        self.assertGreater(len(paths), 3)
        for path in paths:
            with self.subTest(path.name):
                self.validator.validate(yaml.load(path.read_text(), Loader))

    def test_takes_what_the_reader_takes(self):
        for text in ("parts: [%s]\nbin:\nsensors:\n" % BOLT,
                     "parts: [%s]\ngrippers: [robotiq_2f_85, {type: suction, name: cup, radius: 0.01}]" % BOLT,
                     "parts: [{model: a.stl, fixed: true, poses: [[0, 0, 0], [0, 0, 0, 0, 0, 0, 1]]}]",
                     "parts: [%s]\nsensors: [{pose: {position: [0, 0, 1], orientation_xyzw: [1, 0, 0, 0]}}]" % BOLT):
            with self.subTest(text):
                self.validator.validate(yaml.load(text, Loader))

    def test_every_default_is_allowed(self):
        count = 0

        def check(schema):
            nonlocal count
            for key, value in schema.get("properties", {}).items():
                if "default" in value:
                    count += 1
                    jsonschema.Draft7Validator(value).validate(value["default"])
                    self.assertTrue(value["description"], key)
                check(value)
                check(value.get("items", {}))

        check(self.schema)
        self.assertGreater(count, 150)

    def test_refuses_what_the_reader_refuses(self):
        with tempfile.TemporaryDirectory() as folder:
            for i, (text, key) in enumerate(WRONG.items()):
                with self.subTest(text):
                    error = jsonschema.exceptions.best_match(self.validator.iter_errors(yaml.load(text, Loader)))
                    self.assertIsNotNone(error)
                    found = list(error.absolute_path)
                    self.assertEqual("/".join(str(p) for p in found[:key.count("/") + 1 if key else 0]), key)
                    request = pathlib.Path(folder) / ("%d.yaml" % i)
                    request.write_text(text)
                    ran = subprocess.run([TOOL, "generate", str(request), "--out", folder + "/out"],
                                         stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                    self.assertEqual(ran.returncode, 2, ran.stderr)


if __name__ == "__main__":
    TOOL = sys.argv.pop(1)
    unittest.main()
