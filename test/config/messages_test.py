#!/usr/bin/env python3
"""The comments of messages are the texts of the tables of keys (docs/develop/architecture.md, One table for each struct).

    messages_test.py TOOL             compares
    messages_test.py TOOL --update    writes the texts into msg/

Above a field stands the text of its key. What only the message means, such as what an empty array says, stands behind
it. A field without a key is in OWN.
"""
import json
import pathlib
import re
import subprocess
import sys
import textwrap
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
REQUEST = {"Bin": "bin", "PartLine": "parts", "Surface": "parts.surface", "Motion": "parts.motion", "Sensor": "sensors",
           "Table": "table", "SceneRequest": ""}
SCENE = {"SceneReport": "report", "Penetration": "report.penetration", "Drift": "report.drift",
         "Energy": "report.energy", "Flag": "report.flags", "ScenePart": "parts", "Scene": ""}
ALIASES = {"Sensor.K": "k", "Sensor.D": "distortion", "SceneRequest.index": "first", "SceneRequest.solver": "solver.type",
           "SceneReport.stages": "stages_ms"}
# Their comments are their own.
OWN = {"Bin.kind", "SceneRequest.file", "SceneRequest.yaml", "SceneRequest.set", "SceneRequest.render", "Scene.header",
       "ScenePart.frame_id", "Drift.measured", "Drift.distance", "Penetration.depth"}
FIELD = re.compile(r"([\w/]+(?:\[\d*\])?)\s+(\w+)\s*(#.*)?$")


def request_texts(tool):
    texts = {}

    def add(prefix, schema):
        for name, key in schema.get("properties", {}).items():
            texts[prefix + name] = ("One of " + ", ".join(key["enum"]) + ". " if "enum" in key else "") + key["description"]
            add(prefix + name + ".", key)
            add(prefix + name + ".", key.get("items", {}))

    add("", json.loads(subprocess.run([tool, "reference", "--json-schema"], check=True, stdout=subprocess.PIPE).stdout))
    return texts


def scene_texts(tool):
    page = subprocess.run([tool, "reference", "--scene"], check=True, stdout=subprocess.PIPE).stdout.decode()
    texts, prefix = {}, ""
    for line in page.splitlines():
        heading = re.match(r"##+ `([\w.\[\]]+)`", line)
        row = re.match(r"\| `(\w+)` \| .* \| (.*) \| (.*) \|$", line)
        if heading:
            prefix = heading[1].replace("[]", "") + "."
        elif row:
            texts[prefix + row[1]] = ("Unit: " + row[2] + ". " if row[2] else "") + row[3].replace("\\|", "|")
    return texts


def key_of(message, field, section, texts):
    name = ALIASES.get(message + "." + field, field)
    for path in [name] + [name[:i] + "." + name[i + 1:] for i, c in enumerate(name) if c == "_"]:
        path = section + "." + path if section else path
        if path in texts:
            return path
    return None


def written_anew(message, section, texts):
    """The file with the texts of the tables, and its fields that have no key."""
    lines, block, unknown = [], [], []
    for line in (ROOT / "msg" / (message + ".msg")).read_text().splitlines():
        field = FIELD.match(line)
        if line.startswith("#"):
            block.append(line)
            continue
        if field and message + "." + field[2] not in OWN:
            path = key_of(message, field[2], section, texts)
            if path is None:
                unknown.append(message + "." + field[2])
            else:
                block = textwrap.wrap(texts[path], 118, initial_indent="# ", subsequent_indent="# ", break_long_words=False)
        lines += block + [line]
        block = []
    return "\n".join(lines + block) + "\n", unknown


def all_messages(tool):
    for sections, texts in ((REQUEST, request_texts(tool)), (SCENE, scene_texts(tool))):
        for message, section in sections.items():
            yield message, written_anew(message, section, texts)


class Messages(unittest.TestCase):
    def test_comments_are_the_texts_of_the_tables(self):
        for message, (text, unknown) in all_messages(TOOL):
            with self.subTest(message):
                self.assertEqual(unknown, [], "no table has such a key")
                self.assertEqual((ROOT / "msg" / (message + ".msg")).read_text(), text, "run: messages_test.py TOOL --update")


if __name__ == "__main__":
    TOOL = sys.argv.pop(1)
    if "--update" in sys.argv:
        for name, (content, _) in all_messages(TOOL):
            (ROOT / "msg" / (name + ".msg")).write_text(content)
    else:
        unittest.main()
