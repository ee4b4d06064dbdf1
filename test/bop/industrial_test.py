#!/usr/bin/python3
"""BOP's industrial layout: files of several sensors with one image number, views, targets, and what is refused.

    industrial_test.py TOOL
"""
import csv
import json
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "dataset"))
import data_set  # noqa: E402
from data_set import DataSetTest
from bin_scenes_data import read_png

INDUSTRIAL = """bop: {layout: industrial, modalities: {camera: [rgb, depth]}, evaluate: {sensor: camera, modality: rgb}}
split: {train_pbr: 0.5, test: 0.5}"""
SIDE = "    - {name: side, width: 64, height: 48, pose: [0.3, 0, 0.5, 0.9272, 0, -0.3746, 0]}"
CAMERA = "    - {name: camera, width: 96, height: 72}"
LOOK = "  sensors[0].pose:"


def load(path):
    return json.loads(path.read_text())


class Industrial(DataSetTest):
    def plan_of(self, bop=INDUSTRIAL, scenes=4, camera=CAMERA, side=SIDE, outputs="json, png, bop"):
        name = self.plan(scenes=scenes, outputs=outputs, more=bop)
        path = self.folder / name
        text = path.read_text().replace(CAMERA, camera).replace(SIDE, side)
        if camera != CAMERA:
            text = "\n".join(line for line in text.splitlines() if not line.startswith(LOOK)) + "\n"
        path.write_text(text)
        return name

    def made(self, **what):
        self.make(self.plan_of(**what), "out")
        return self.folder / "out/bop"

    def scenes(self, root):
        return [(split, path) for split in ("train_pbr", "test") for path in sorted((root / split).iterdir())]

    def refused(self, *words, **what):
        done = self.make(self.plan_of(**what), "refused", code=2)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertFalse((self.folder / "refused").exists(), "nothing half written")

    def test_one_moment_has_one_number_whatever_the_sensor(self):
        root = self.made()
        scenes = self.scenes(root)
        self.assertEqual(len(scenes), 4)
        for _, scene in scenes:
            for sensor, modalities in (("camera", ("rgb", "depth")), ("side", ("gray", "depth"))):
                self.assertEqual(sorted(p.name for p in scene.iterdir() if p.name.endswith("_" + sensor)),
                                 sorted(kind + "_" + sensor for kind in (*modalities, "mask", "mask_visib")))
                for modality in modalities:
                    self.assertEqual([p.name for p in (scene / (modality + "_" + sensor)).iterdir()], ["000000.png"])
                truth = load(scene / ("scene_gt_%s.json" % sensor))
                self.assertEqual(list(truth), ["0"])
                for kind in ("mask", "mask_visib"):
                    self.assertEqual(len(list((scene / (kind + "_" + sensor)).iterdir())), len(truth["0"]))
            rgb = read_png((scene / "rgb_camera/000000.png").read_bytes())
            self.assertEqual(rgb.shape, (72, 96, 3))
            self.assertTrue((rgb == rgb[..., :1]).all() and rgb.max() > 50)

    def test_coco_annotates_what_is_seen(self):
        annotated = 0
        for _, scene in self.scenes(self.made()):
            coco = load(scene / "scene_gt_coco_side.json")
            truth, info = (load(scene / (name + "_side.json"))["0"] for name in ("scene_gt", "scene_gt_info"))
            self.assertEqual([c["id"] for c in coco["categories"]], [1, 2])
            self.assertEqual([i["file_name"] for i in coco["images"]], ["gray_side/000000.png"])
            seen = [i for i, entry in enumerate(info) if entry["px_count_visib"]]
            self.assertEqual(len(coco["annotations"]), len(seen))
            for number, annotation in zip(seen, coco["annotations"]):
                visible, whole = (read_png((scene / (kind + "_side/000000_%06d.png" % number)).read_bytes()) > 0
                                  for kind in ("mask_visib", "mask"))
                flat = np.zeros(visible.size, bool)
                ends = np.cumsum(annotation["segmentation"]["counts"])
                for begin, end in zip(ends[0::2], ends[1::2]):
                    flat[begin:end] = True
                np.testing.assert_array_equal(flat.reshape(visible.shape, order="F"), visible)
                rows, columns = whole.nonzero()
                self.assertEqual(annotation["bbox"], [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1])
                self.assertEqual(annotation["category_id"], truth[number]["obj_id"])
                self.assertEqual(annotation["ignore"], info[number]["visib_fract"] < 0.1)
                annotated += 1
        self.assertGreater(annotated, 8)

    def test_cameras_targets_and_description_lie_beside_the_scenes(self):
        root = self.made()
        tests = [int(path.name) for split, path in self.scenes(root) if split == "test"]
        camera = load(root / "camera_side.json")
        self.assertEqual((camera["width"], camera["height"]), (64, 48))
        self.assertEqual(load(root / "camera.json"), load(root / "camera_camera.json"))
        self.assertEqual(load(root / "test_targets_bop24.json"), [{"im_id": 0, "scene_id": scene} for scene in tests])
        for target in load(root / "test_targets_bop19.json"):
            scene = root / "test" / ("%06d" % target["scene_id"])
            pairs = zip(load(scene / "scene_gt_camera.json")["0"], load(scene / "scene_gt_info_camera.json")["0"])
            self.assertEqual(target["inst_count"],
                             sum(gt["obj_id"] == target["obj_id"] and info["visib_fract"] >= 0.1 for gt, info in pairs))
        self.assertEqual(load(root / "test_targets_multiview_bop25.json"),
                         [{"im_id": [["camera", 0], ["side", 0]], "scene_id": scene} for scene in tests])
        described = load(root / "dataset_info.json")
        self.assertEqual(described["splits"], {"train_pbr": 4 - len(tests), "test": len(tests)})
        self.assertEqual(described["sensors"]["camera"]["modalities"], ["rgb", "depth"])

    def test_views_are_images_of_one_sensor_of_the_same_heap(self):
        bop = "bop: {layout: industrial}"
        root = self.made(bop=bop, scenes=1, outputs="json, bop",
                         camera="    - {name: camera, width: 96, height: 72, views: {count: 5, distance: 0.6, tilt: 0.5}}")
        scene = root / "train/000000"
        cameras = load(scene / "scene_camera_camera.json")
        truth = load(scene / "scene_gt_camera.json")
        self.assertEqual(list(cameras), [str(view) for view in range(5)])
        self.assertEqual(len(list((scene / "depth_camera").iterdir())), 5)
        self.assertEqual(load(root / "test_targets_multiview_bop25.json"),
                         [{"im_id": [["camera", view] for view in range(5)], "scene_id": 0}])
        centres, worlds = [], []
        for view in cameras:
            turn = np.array(cameras[view]["cam_R_w2c"]).reshape(3, 3)
            centre = -turn.T @ cameras[view]["cam_t_w2c"]
            self.assertAlmostEqual(np.linalg.norm(centre), 600, places=6)
            self.assertLess(np.arccos(centre[2] / 600), 0.5)
            np.testing.assert_allclose(turn[2], -centre / 600, atol=1e-9)  # each looks at the middle of the floor
            centres.append(centre)
            worlds.append([turn.T @ (np.array(part["cam_t_m2c"]) - cameras[view]["cam_t_w2c"]) for part in truth[view]])
        for world in worlds[1:]:
            np.testing.assert_allclose(world, worlds[0], atol=1e-6)
        self.assertGreater(min(np.linalg.norm(a - b) for i, a in enumerate(centres) for b in centres[:i]), 100)
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "out").stdout)
        request = (self.folder / "out/scenes/scene_000000/request.yaml").read_text()
        self.assertEqual(request.count('view_of: "camera"'), 5)

    def test_views_of_another_sensor_are_looked_at_together_with_the_evaluated_one(self):
        root = self.made(bop="bop: {layout: industrial}", scenes=1, outputs="json, bop",
                         side="    - {name: side, width: 64, height: 48, views: {count: 3, distance: 0.5, tilt: 0.5}}")
        self.assertEqual(load(root / "test_targets_multiview_bop25.json"),
                         [{"im_id": [["camera", 0], ["side", 0], ["side", 1], ["side", 2]], "scene_id": 0}])

    def test_the_toy_estimator_is_scored(self):
        self.made(camera="    - {name: camera, width: 480, height: 360, fov: 0.6, pose: [0, 0, 0.6, 1, 0, 0, 0]}")
        results = self.folder / "toy_mybins-test_pose.csv"

        def scores(move):
            done = subprocess.run(
                [sys.executable, data_set.ROOT / "python/examples/toy_estimator.py", self.folder / "out/bop", "--sensor", "camera",
                 "--move", str(move), "--turn", str(move), "--out", results],
                capture_output=True, text=True, env={"PYTHONPATH": str(data_set.ROOT / "python")})
            self.assertEqual(done.returncode, 0, done.stderr)
            return [float(score) for score in re.findall(r"score ([0-9.]+)", done.stdout)]
        start, found = scores(5)
        self.assertGreater(found, start + 0.1)
        self.assertGreater(found, 0.9)
        start, found = scores(0)
        self.assertEqual(start, 1)
        self.assertGreater(found, 0.95)
        with open(results, newline="") as file:
            rows = list(csv.DictReader(file))
        truth = [part for split, scene in self.scenes(self.folder / "out/bop") if split == "test"
                 for part in load(scene / "scene_gt_camera.json")["0"]]
        self.assertEqual([int(row["obj_id"]) for row in rows], [part["obj_id"] for part in truth])
        for row in rows:
            turn = np.array(row["R"].split(), float).reshape(3, 3)
            np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-6)
        missing = subprocess.run([sys.executable, data_set.ROOT / "python/examples/toy_estimator.py", self.folder / "out/bop",
                                  "--sensor", "camera", "--split", "tset"], capture_output=True, text=True,
                                 env={"PYTHONPATH": str(data_set.ROOT / "python")})
        self.assertEqual(missing.returncode, 2)
        self.assertIn("there are: test, train_pbr", missing.stderr)

    def test_tif_of_every_modality_is_what_png_is(self):
        png = self.made()
        tif = self.folder / "tif/bop"
        self.make(self.plan_of(bop=INDUSTRIAL.replace("industrial,", "industrial, format: tif,")), "tif")
        for folder in ("rgb_camera", "depth_camera", "gray_side", "depth_side"):
            for split, scene in self.scenes(png):
                same = np.asarray(Image.open(tif / split / scene.name / folder / "000000.tif"))
                np.testing.assert_array_equal(same, read_png((scene / folder / "000000.png").read_bytes()))
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "tif").stdout)

    def test_classic_train_pbr_has_jpeg_of_three_channels(self):
        root = self.made(bop="split: {train_pbr: 0.5, val: 0.5}", scenes=2)
        rgb = np.asarray(Image.open(root / "train_pbr/000000/rgb/000000.jpg")).astype(int)
        gray = np.asarray(Image.open(root / "train_pbr/000000/gray/000000.tiff")).astype(int)
        self.assertEqual(rgb.shape, (72, 96, 3))
        self.assertLess(np.abs(rgb - gray[..., None]).mean(), 2)
        self.assertFalse((root / "val/000001/rgb").exists())
        self.assertEqual(load(root / "dataset_info.json")["targets"], "val")

    def test_models_for_evaluation_have_vertices_all_over(self):
        root = self.made(scenes=1, bop="")
        for name, size in (("obj_000001.ply", data_set.BOX), ("obj_000002.ply", data_set.BAR)):
            head, _, body = (root / "models_eval" / name).read_bytes().partition(b"end_header\n")
            count = int(head.split(b"element vertex ")[1].split()[0])
            vertices = np.frombuffer(body, "<f4", 3 * count).reshape(-1, 3)
            np.testing.assert_allclose(np.ptp(vertices, axis=0), 1e3 * np.array(size), atol=1e-3)  # corners stay
            random = np.random.default_rng(1)
            points = (random.random((500, 3)) - 0.5) * size * 1e3
            axis = random.integers(0, 3, 500)
            points[range(500), axis] = np.sign(points[range(500), axis]) * np.array(size)[axis] * 500
            gaps = np.linalg.norm(points[:, None] - vertices, axis=-1).min(1)
            self.assertLess(gaps.max(), 0.06 * 1e3 * np.linalg.norm(size))
            self.assertLess(count, 4000)

    def test_the_entry_for_the_toolkit_is_python(self):
        self.made()
        text = self.run_tool("dataset", "toolkit", "out", "--name", "mybins").stdout
        ids, symmetric, branch = [part.split("\n", 1)[1] for part in text.split("# ")[1:]]
        self.assertEqual(eval("{" + ids + "}"), {"mybins": [1, 2]})
        self.assertEqual(eval("{" + symmetric + "}"), {"mybins": [1, 2]})
        told = {"p": {}, "dataset_name": "mybins", "split": "train", "split_type": "pbr"}
        exec("if True:\n    if False: pass\n" + branch, told)
        self.assertEqual(told["p"]["im_size"]["side"], (64, 48))
        self.assertEqual(told["p"]["eval_sensor"], "camera")
        self.assertEqual(told["exts"]["camera"], {"rgb": ".png", "depth": ".png"})
        self.assertEqual(len(told["p"]["scene_ids"]), 2)
        self.assertIn("is no name", self.run_tool("dataset", "toolkit", "out", "--name", "my-bins", code=2).stderr)

    def test_made_in_shares_and_grown_it_is_the_same(self):
        self.made()
        for share in ("0/2", "1/2"):
            self.make("plan.yaml", "share" + share[0], "--shard", share)
        self.run_tool("dataset", "merge", "share0", "share1", "--out", "merged")
        self.assert_same("out", "merged")
        self.make(self.plan_of(scenes=2), "grown")
        self.make(self.plan_of(scenes=4), "grown")
        self.assert_same("out", "grown")

    def test_what_the_layout_cannot_hold_is_refused(self):
        def industrial(more):
            return "bop: {layout: industrial, %s}" % more
        self.refused("'aolp' is not simulated", "bop.modalities.camera", bop=industrial("modalities: {camera: [rgb, aolp]}"))
        self.refused("no sensor 'cammera'", "did you mean 'camera'?", bop=industrial("modalities: {cammera: [rgb]}"))
        self.refused("has no modality rgb", bop=industrial("evaluate: {sensor: side, modality: rgb}"))
        self.refused("belong to the layout industrial", bop="bop: {format: tif}")
        self.refused("expected classic or industrial", bop="bop: {layout: industry}")
        self.refused("is unknown", "bop.layuot", bop="bop: {layuot: industrial}")
        self.refused("shares add up to 0.9", bop="split: {train: 0.5, test: 0.4}")
        self.refused("cannot be the name of a split", bop="split: {models_eval: 1}")

    def test_views_that_cannot_be_are_refused(self):
        def views(text):
            return "    - {name: camera, width: 96, height: 72, views: %s}" % text
        self.refused("view 1 stands inside the bin", camera=views("{poses: [[0, 0, 0.5, 1, 0, 0, 0], [0, 0, 0.1, 1, 0, 0, 0]]}"))
        self.refused("view 0 stands inside the bin", camera=views("{count: 3, distance: 0.05}"))
        self.refused("needs either poses or count", camera=views("{distance: 0.5}"))
        self.refused("must be 0 to less than pi/2", camera=views("{count: 3, tilt: 2}"))
        self.refused("the sensor also has the key `pose`", camera=views("{count: 3}, pose: [0, 0, 1, 1, 0, 0, 0]"))

    def test_rigs_bring_sensors_and_what_bop_says_of_them(self):
        for rig, evaluated, extension in (("ipd", "rgb_photoneo", "png"), ("xyzibd", "gray_xyz", "png"),
                                          ("itoddmv", "gray_3dlong", "tif")):
            with self.subTest(rig=rig):
                path = self.folder / "rig.yaml"
                path.write_text("""seed: 1
scenes: 1
outputs: [json, bop]
bop: {layout: industrial}
request:
  bin: {inner_size: [0.24, 0.2, 0.15]}
  solver: {type: bullet}
  parts: [{model: box.stl, count: 2}]
  rig: %s
draw:
%s
""" % (rig, "\n".join("  sensors[%d].%s" % (sensor, value) for sensor in range(4 if rig != "xyzibd" else 3)
                      for value in ("width: 64", "height: 48", "k: [60, 0, 31.5, 0, 60, 23.5, 0, 0, 1]"))))
                self.make("rig.yaml", rig)
                scene = self.folder / rig / "bop/train/000000"
                self.assertTrue((scene / evaluated / ("000000." + extension)).is_file())
                self.assertIn(" 0 findings", self.run_tool("dataset", "verify", rig).stdout)
        (self.folder / "wrong.yaml").write_text("parts: [{model: box.stl}]\nrig: xyzbd\n")
        self.assertIn("did you mean 'xyzibd'?", self.run_tool("generate", "wrong.yaml", "--out", "x", code=2).stderr)
        (self.folder / "wrong.yaml").write_text("parts: [{model: box.stl}]\nrig: ipd\nsensors: [{name: a}]\n")
        self.assertIn("both give sensors", self.run_tool("generate", "wrong.yaml", "--out", "x", code=2).stderr)

    def test_each_corruption_is_found(self):
        self.made()
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "out").stdout)
        for number, (check, corrupt) in enumerate(CORRUPTIONS):
            with self.subTest(number=number, check=check):
                shutil.rmtree(self.folder / "broken", ignore_errors=True)
                shutil.copytree(self.folder / "out", self.folder / "broken")
                corrupt(self.folder / "broken")
                self.assertIn("\n" + check + ": ", "\n" + self.run_tool("dataset", "verify", "broken", code=1).stdout)


def change(name, how):
    def corrupt(root):
        value = load(root / name)
        value = how(value) or value
        (root / name).write_text(json.dumps(value))
    return corrupt


def drop(name):
    return lambda root: (root / name).unlink()


SCENE = "bop/test/000001/"
CORRUPTIONS = [
    ("bop_coco", change(SCENE + "scene_gt_coco_camera.json", lambda c: c["annotations"].pop())),
    ("bop_coco", change(SCENE + "scene_gt_coco_camera.json", lambda c: c["annotations"][0].update(category_id=9))),
    ("bop_coco", change(SCENE + "scene_gt_coco_side.json", lambda c: c["annotations"][0]["segmentation"]["counts"].append(1))),
    ("bop_coco", drop(SCENE + "scene_gt_coco_side.json")),
    ("bop_json", drop(SCENE + "scene_gt_info_side.json")),
    ("bop_image", drop(SCENE + "rgb_camera/000000.png")),
    ("bop_image", lambda root: shutil.copy(root / SCENE / "gray_side/000000.png", root / SCENE / "depth_side/000000.png")),
    ("bop_mask_there", drop(SCENE + "mask_side/000000_000000.png")),
    ("bop_pose", change(SCENE + "scene_gt_side.json", lambda t: t["0"][0].update(cam_t_m2c=[0, 0, 500]))),
    ("bop_camera", change(SCENE + "scene_camera_side.json", lambda c: c["0"]["cam_K"].__setitem__(2, 30.5))),
    ("bop_camera", change(SCENE + "scene_camera_side.json", lambda c: c["0"].update(depth_scale=1))),
    ("bop_camera", change(SCENE + "scene_camera_camera.json", lambda c: c["0"]["cam_t_w2c"].__setitem__(0, 1))),
    ("bop_camera", change(SCENE + "scene_camera_camera.json", lambda c: c["0"].update(cam_R_w2c=[1, 0, 0, 0, 1, 0, 0, 0, 1]))),
    ("bop_root", change("bop/camera_side.json", lambda c: c.update(fx=1))),
    ("bop_root", drop("bop/camera.json")),
    ("bop_root", change("bop/dataset_info.json", lambda d: d.update(targets="val"))),
    ("bop_root", change("bop/test_targets_bop19.json", lambda t: t[1:])),
    ("bop_root", change("bop/test_targets_bop24.json", lambda t: t + [{"im_id": 7, "scene_id": 1}])),
    ("bop_root", drop("bop/test_targets_multiview_bop25.json")),
    ("model_eval", lambda root: shutil.copy(root / "bop/models_eval/obj_000001.ply", root / "bop/models_eval/obj_000002.ply")),
    ("model_eval", change("bop/models_eval/models_info.json", lambda m: m.pop("2") and None)),
]


if __name__ == "__main__":
    data_set.main()
