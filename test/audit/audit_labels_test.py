#!/usr/bin/python3
"""`bin_scenes audit` names what was spoiled in a copy of a clean set, and nothing else; clean sets pass.

    audit_labels_test.py TOOL
"""
import json
import pathlib
import shutil
import sys

import numpy as np
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dataset"))
import data_set  # noqa: E402
from data_set import DataSetTest

# Two cameras of one heap: exact depth, and depth with noise, shadows and indirect light. 0.5 mm a pixel.
PLAN = """seed: 5
scenes: 2
outputs: [json, bop]
%s
request:
  bin: {inner_size: [0.24, 0.2, 0.15]}
  solver: {type: bullet}
  parts:
    - {model: box.stl, count: 9, surface: {albedo: 0.4}}
    - {model: bar.stl, count: 8}
  sensors:
    - {name: camera, width: 640, height: 480, fov: 0.6, pose: [0, 0, 0.55, 1, 0, 0, 0]}
    - {name: noisy, model: structured_light, width: 640, height: 480, fov: 0.6, projector: {baseline: 0.15, fov: 0.7},
       pose: [0, 0, 0.55, 1, 0, 0, 0]}
"""
LABELS = ("mask", "mask_visib", "shift", "depth", "counted", "camera", "depth_common", "faults")


def read(path):
    return json.loads(path.read_text())


def rewrite(path, change):
    content = read(path)
    change(content)
    path.write_text(json.dumps(content))


def mask_at(path):
    return np.asarray(Image.open(path)) > 0


class AuditLabels(DataSetTest):
    clean = None  # made once

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.clean.parent, ignore_errors=True)

    def setUp(self):
        super().setUp()
        if AuditLabels.clean is None:
            (self.folder / "plan.yaml").write_text(PLAN % "")
            self.make("plan.yaml", "set")
            AuditLabels.clean = self.folder.parent / (self.folder.name + "_clean") / "set"
            AuditLabels.clean.parent.mkdir()
            shutil.copytree(self.folder / "set", AuditLabels.clean)
        shutil.rmtree(self.folder / "set", ignore_errors=True)
        shutil.copytree(AuditLabels.clean, self.folder / "set")
        self.scenes = [self.folder / "set/bop/train" / name for name in ("000000", "000001")]

    def audit(self, *words, code=None, where="set"):
        done = self.run_tool("audit", where, "--json", *words, code=code)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        result = json.loads(done.stdout)
        self.assertEqual(done.returncode, 1 if result["exceeded"] else 0)
        return result

    def named(self, result):
        """{(scene, image, entry): text} of the parts that labels accuse, not neighbours that now overlap."""
        return {(int(p["scene"][-6:]), p["image"], p["entry"]): "; ".join(p["faults"]) for p in result["worst_parts"]
                if p["score"] > 100}

    def images(self, result):
        return {(int(i["scene"][-6:]), i["image"]): "; ".join(i["faults"]) for i in result["worst_images"] if i["faults"]}

    def truth(self, scene, change):
        rewrite(self.scenes[scene] / "scene_gt.json", change)

    def camera(self, scene, change):
        rewrite(self.scenes[scene] / "scene_camera.json", lambda all_images: [change(c) for c in all_images.values()])

    def move(self, scene, image, entry, by):
        def change(truth):
            part = truth[str(image)][entry]
            part["cam_t_m2c"] = [a + b for a, b in zip(part["cam_t_m2c"], by)]
        self.truth(scene, change)

    def swap(self, scene, image, a, b, keys):
        def change(truth):
            one, other = truth[str(image)][a], truth[str(image)][b]
            for key in keys:
                one[key], other[key] = other[key], one[key]
        self.truth(scene, change)

    def open_entries(self, scene, image, count):
        """Entries of the parts that are seen best."""
        info = read(self.scenes[scene] / "scene_gt_info.json")[str(image)]
        return sorted(range(len(info)), key=lambda i: -info[i]["visib_fract"])[:count]

    def test_clean_sets_pass_with_noise_and_occlusion(self):
        result = self.audit(code=0)
        self.assertEqual((result["exceeded"], result["faults"], self.named(result)), ([], [], {}))
        by = {m["key"]: m for m in result["measures"]}
        self.assertEqual(by["mask"]["max"], 0)
        self.assertEqual(by["shift"]["max"], 0)
        self.assertGreater(by["shift"]["count"], 60)  # of 68
        self.assertGreater(by["depth"]["count"], 40)
        info = read(self.scenes[0] / "scene_gt_info.json")["0"]
        self.assertLess(min(i["visib_fract"] for i in info), 0.9)  # some parts are covered
        text = self.run_tool("audit", "set", "--out", "page.html").stdout
        self.assertIn("within all limits", text)
        self.assertIn("Worst parts", (self.folder / "page.html").read_text())

    def test_parts_moved_by_2_mm_are_named_with_direction_and_size(self):
        along_x, along_y, along_z = self.open_entries(0, 0, 3)
        truth = read(self.scenes[0] / "scene_gt.json")["0"]
        focal = read(self.scenes[0] / "scene_camera.json")["0"]["cam_K"][0]
        self.move(0, 0, along_x, (2, 0, 0))
        self.move(0, 0, along_y, (0, 2, 0))
        self.move(0, 0, along_z, (0, 0, 2))
        result = self.audit(code=1)
        named = self.named(result)
        self.assertEqual(set(named), {(0, 0, along_x), (0, 0, along_y), (0, 0, along_z)}, named)
        parts = {p["entry"]: p for p in result["worst_parts"] if p["score"] > 100}
        for entry, axis in ((along_x, 0), (along_y, 1)):
            expected = -2 * focal / truth[entry]["cam_t_m2c"][2]  # the mask stayed where the part was
            self.assertAlmostEqual(parts[entry]["shift_px"][axis], expected, delta=0.25)  # its top is nearer than its centre
            self.assertAlmostEqual(parts[entry]["shift_px"][1 - axis], 0, delta=0.1)
        self.assertAlmostEqual(parts[along_z]["depth_mm"], -2, delta=0.05)
        self.assertIn("before the model", named[0, 0, along_z])

    def test_a_part_moved_under_noise_is_named(self):
        entry = self.open_entries(1, 1, 1)[0]
        self.move(1, 1, entry, (0, 0, 2))
        named = self.named(self.audit(code=1))
        self.assertEqual(set(named), {(1, 1, entry)}, named)
        self.assertIn("depth", named[1, 1, entry])

    def test_errors_of_all_parts_are_no_noise(self):
        random = np.random.default_rng(2)
        count = len(read(self.scenes[0] / "scene_gt.json")["0"])
        for entry, error in enumerate(random.normal(0, 2, count)):
            self.move(0, 0, entry, (0, 0, error))
        result = self.audit("--limit", "views_mm=100", code=1)
        self.assertIn("depth", result["exceeded"])
        named = [p for p in self.named(result) if p[:2] == (0, 0)]
        self.assertGreater(len(named), 0.4 * count)  # 1 mm is half a standard deviation: 62 %

    def test_missing_files_are_named(self):
        removed = {"mask/000000_000002.png": (0, 0, 2), "mask_visib/000001_000004.png": (0, 1, 4)}
        for name, place in removed.items():
            (self.scenes[0] / name).unlink()
        (self.scenes[1] / "depth/000000.png").unlink()
        result = self.audit(code=1)
        named = self.named(result)
        self.assertEqual(set(named), set(removed.values()))
        for name, place in removed.items():
            self.assertIn("missing: " + "set/bop/train/000000/" + name, named[place])
        self.assertEqual(self.images(result), {(1, 0): "its depth image is missing"})
        shutil.rmtree(self.scenes[0] / "mask_visib")
        self.assertEqual(len([p for p in self.named(self.audit(code=1)) if p[0] == 0]), 20 - len(
            [p for p in self.named(self.audit(code=1)) if p[0] == 1]))

    def test_exchanged_parts_objects_and_ids_are_named(self):
        with self.subTest("masks of two parts"):
            folder = self.scenes[0] / "mask"
            one, other = folder / "000000_000001.png", folder / "000000_000003.png"
            content = one.read_bytes()
            one.write_bytes(other.read_bytes())
            other.write_bytes(content)
            named = self.named(self.audit(code=1))
            self.assertEqual(set(named), {(0, 0, 1), (0, 0, 3)}, named)
            self.assertIn("its mask shows entry 3", named[0, 0, 1])
            self.assertIn("its mask shows entry 1", named[0, 0, 3])
            other.write_bytes(one.read_bytes())
            one.write_bytes(content)
        with self.subTest("entries of two parts"):
            self.swap(0, 0, 1, 3, ("cam_R_m2c", "cam_t_m2c"))
            named = self.named(self.audit(code=1))
            self.assertEqual(set(named), {(0, 0, 1), (0, 0, 3)}, named)
            self.assertIn("shows entry 3", named[0, 0, 1])
            self.swap(0, 0, 1, 3, ("cam_R_m2c", "cam_t_m2c"))
        with self.subTest("objects of a box and a bar"):
            truth = read(self.scenes[0] / "scene_gt.json")["0"]
            seen = self.open_entries(0, 0, len(truth))
            box = next(i for i in seen if truth[i]["obj_id"] == 1)
            bar = next(i for i in seen if truth[i]["obj_id"] == 2)
            self.swap(0, 0, box, bar, ("obj_id",))
            named = self.named(self.audit(code=1))
            self.assertLessEqual({(0, 0, box), (0, 0, bar)}, set(named), named)
            self.assertIn("fits object 1, obj_id is 2", named[0, 0, box])
            self.assertIn("fits object 2, obj_id is 1", named[0, 0, bar])
            self.swap(0, 0, box, bar, ("obj_id",))
        with self.subTest("ids alone"):
            self.swap(1, 0, 2, 5, ("id",))
            named = self.named(self.audit(code=1))
            self.assertEqual({key: "belongs to entry" in text for key, text in named.items()},
                             {(1, 0, 2): True, (1, 0, 5): True}, named)

    def test_a_camera_that_is_off_is_fitted_and_no_part_is_accused(self):
        def k(index, change):
            for scene in (0, 1):
                def apply(camera):
                    camera["cam_K"][index] = change(camera["cam_K"][index])
                self.camera(scene, apply)
        k(2, lambda cx: cx + 2)
        result = self.audit(code=1)
        self.assertEqual(result["exceeded"], ["camera"])
        self.assertEqual(len(result["faults"]), 1)  # both sensors have one K
        self.assertIn("cx -2.00 px", result["faults"][0])
        self.assertNotIn("cy", result["faults"][0].split("which say")[1])
        self.assertEqual(len(self.images(result)), 4)
        k(2, lambda cx: cx - 2)
        k(0, lambda fx: fx * 1.01)
        result = self.audit(code=1)
        self.assertEqual(self.named(result), {})
        self.assertRegex(result["faults"][0], r"fx -(0\.9[5-9]|1\.0[0-5]) %")  # 1 / 1.01
        k(0, lambda fx: fx / 1.01)
        k(2, lambda cx: cx + 0.3)  # within the limit, and not charged to parts
        self.assertEqual(self.audit(code=0)["faults"], [])

    def test_one_image_that_is_off_is_named(self):
        def change(cameras):
            cameras["1"]["cam_K"][5] -= 2
        rewrite(self.scenes[1] / "scene_camera.json", change)
        result = self.audit(code=1)
        self.assertEqual(list(self.images(result)), [(1, 1)])
        self.assertIn("(+0.00, +2.00) px", self.images(result)[1, 1])
        self.assertEqual(self.named(result), {})

    def test_depth_by_another_convention_is_named(self):
        for scene in (0, 1):
            self.camera(scene, lambda camera: camera.update(depth_scale=camera["depth_scale"] * 10))
        result = self.audit(code=1)
        self.assertIn("depth_scale", " ".join(result["faults"]))
        for scene in (0, 1):
            self.camera(scene, lambda camera: camera.update(depth_scale=camera["depth_scale"] / 10))
        for scene in self.scenes:
            k = read(scene / "scene_camera.json")["0"]["cam_K"]
            for path in (scene / "depth").glob("*.png"):
                depth = np.asarray(Image.open(path)).astype(float)
                y, x = np.mgrid[:depth.shape[0], :depth.shape[1]]
                ray = np.sqrt(((x - k[2]) / k[0]) ** 2 + ((y - k[5]) / k[4]) ** 2 + 1)
                Image.fromarray(np.round(depth * ray).astype(np.uint16)).save(path)
        result = self.audit("--limit", "depth_common=0.5", code=1)
        self.assertIn("distances from the camera", " ".join(result["faults"]))
        self.assertEqual(self.named(result), {})

    def warped(self, strength, back):
        """Masks as a lens with k1 images them; `back`: rectified again."""
        for scene in self.scenes:
            k = read(scene / "scene_camera.json")["0"]["cam_K"]
            y, x = np.mgrid[:480, :640]
            u, v = (x - k[2]) / k[0], (y - k[5]) / k[4]
            factor = 1 + strength * (u * u + v * v)
            ideal = u, v  # of distorted pixels, by fixed-point steps
            for _ in range(20):
                squared = ideal[0] ** 2 + ideal[1] ** 2
                ideal = u / (1 + strength * squared), v / (1 + strength * squared)
            for path in [*(scene / "mask").glob("*.png"), *(scene / "mask_visib").glob("*.png")]:
                image = mask_at(path)
                steps = [ideal] + ([(u * factor, v * factor)] if back else [])
                for to_u, to_v in steps:
                    column, row = np.round(to_u * k[0] + k[2]).astype(int), np.round(to_v * k[4] + k[5]).astype(int)
                    inside = (column >= 0) & (column < 640) & (row >= 0) & (row < 480)
                    image = np.where(inside, image[np.clip(row, 0, 479), np.clip(column, 0, 639)], False)
                Image.fromarray(np.uint8(255) * image).save(path)

    def test_a_lens_whose_distortion_is_left_is_named_and_a_rectified_one_is_clean(self):
        self.warped(0.1, back=True)
        result = self.audit("--limit", "counted=100")
        self.assertEqual((self.named(result), result["faults"]), ({}, []))
        shutil.rmtree(self.folder / "set")
        shutil.copytree(AuditLabels.clean, self.folder / "set")
        self.warped(0.1, back=False)
        result = self.audit("--limit", "counted=100", code=1)
        self.assertRegex(result["faults"][0], r"k1 \+0\.(0[89]|1[012])")
        self.assertEqual(self.named(result), {})

    def others(self):
        """The set as BOP's own tools write it: no ids, no description, masks by bop_toolkit's rule for measured depth
        at 15 mm, whole millimetres, no grey images."""
        (self.folder / "plan.yaml").write_text(PLAN % "bop: {visible: measured, tolerance: 0.015}")
        self.make("plan.yaml", "own")
        shutil.copytree(self.folder / "own/bop", self.folder / "others")
        for scene in (self.folder / "others/train").iterdir():
            rewrite(scene / "scene_gt.json", lambda truth: [p.pop("id") for parts in truth.values() for p in parts])
            for path in (scene / "depth").glob("*.png"):
                image = str(int(path.stem))
                scale = read(scene / "scene_camera.json")[image]["depth_scale"]
                depth = np.round(np.asarray(Image.open(path)) * scale).astype(np.uint16)
                Image.fromarray(depth).save(path)
            rewrite(scene / "scene_camera.json", lambda cameras: [
                c.update(depth_scale=1.0, R_w2c=c.pop("cam_R_w2c"), t_w2c=c.pop("cam_t_w2c")) for c in cameras.values()])
            shutil.rmtree(scene / "gray")
        return [self.folder / "others/train" / name for name in ("000000", "000001")]

    def test_sets_by_other_conventions_pass(self):
        scenes = self.others()
        words = ("--bin", "0.24,0.2,0.15")
        result = self.audit(*words, where="others", code=0)
        self.assertEqual((result["faults"], result["world_stated"], result["heaps"]), ([], True, 2))
        with self.subTest("pixel centres at half a pixel"):
            for scene in scenes:
                def shift(cameras):
                    for camera in cameras.values():
                        camera["cam_K"][2] += 0.5
                        camera["cam_K"][5] += 0.5
                rewrite(scene / "scene_camera.json", shift)
            self.assertEqual(self.named(self.audit(*words, where="others", code=0)), {})
        with self.subTest("mask_visib alone, without depth"):
            for scene in scenes:
                shutil.rmtree(scene / "mask")
            result = self.audit(*words, where="others", code=0)
            self.assertEqual(self.named(result), {})
            self.assertGreater({m["key"]: m["count"] for m in result["measures"]}["shift"], 40)

    def test_all_faults_together_are_named(self):
        along_x, along_y, along_z = self.open_entries(0, 0, 3)
        self.move(0, 0, along_x, (2, 0, 0))
        self.move(0, 0, along_y, (0, -2, 0))
        self.move(0, 0, along_z, (0, 0, 2))
        lost = next(i for i in range(10) if i not in (along_x, along_y, along_z))
        (self.scenes[0] / ("mask/000000_%06d.png" % lost)).unlink()
        self.swap(1, 0, 2, 5, ("cam_R_m2c", "cam_t_m2c", "id"))
        for scene in (0, 1):
            self.camera(scene, lambda camera: camera["cam_K"].__setitem__(2, camera["cam_K"][2] + 2))
        done = self.run_tool("audit", "set", "--out", "page.html", code=1)
        result = self.audit(code=1)
        expected = {(0, 0, along_x), (0, 0, along_y), (0, 0, along_z), (0, 0, lost), (1, 0, 2), (1, 0, 5)}
        self.assertEqual(set(self.named(result)), expected, self.named(result))
        self.assertIn("cx -2.00 px", result["faults"][0])
        page = (self.folder / "page.html").read_text()
        for text in ("mask shifted by", "its mask is missing", "shows entry 5", "cx -2.00 px", "before the model"):
            self.assertIn(text, done.stdout)
            self.assertIn(text, page)

    def test_limits_and_shares_are_options(self):
        entry = self.open_entries(0, 0, 1)[0]
        self.move(0, 0, entry, (2, 0, 0))
        result = self.audit("--limit", "shift=8", "--limit", "views_mm=3", "--limit", "mask=0.5", "--limit",
                            "mask_visib=0.5", "--limit", "depth=5", "--share", "0.5", code=0)
        self.assertEqual(self.named(result), {})
        self.assertEqual({m["key"]: m["limit"] for m in result["measures"]}["shift"], 8)
        for wrong in ("shift", "shift=x", "shape=3", "shift=-1"):
            done = self.run_tool("audit", "set", "--limit", wrong, code=2)
            self.assertIn("keys are overlap, overlap_mm", done.stderr)


if __name__ == "__main__":
    data_set.main()
