#!/usr/bin/python3
"""The live node against what its topics promise: one scene, one stamp, one truth."""

import math
import os
import signal
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

import numpy as np
import rosbag
import rospy
import rostest
import tf2_ros
from sensor_msgs.msg import Image, PointCloud2
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_data as data  # noqa: E402
from scene_client import SMALL  # noqa: E402
from node_case import Listener, MODELS, NodeCase, REQUEST, TOLERANCE, TOPICS, counter  # noqa: E402
from bin_scenes.msg import ErrorCode, PartLine, Scene, SceneRequest, Sensor  # noqa: E402

# Nuts in a mug, seen from above and from the side.
TWO_SENSORS = """
seed: 3
bin: {mesh: mug.stl, unit: mm, pose: [0.01, 0, 0, 0, 0, 0, 1]}
parts: [{model: nut_hex.stl, unit: mm, count: 2}]
solver: {type: sphere}
sensors:
  - {name: camera, width: 240, height: 200}
  - {name: side-view, width: 160, height: 120, pose: [0.3, 0, 0.03, -0.5, -0.5, 0.5, 0.5]}
"""


class NodeTest(NodeCase):
    # One stamp, one truth

    def test_topics_agree(self):
        scene, topics = self.scene_on_topics()
        topics["scene"].header.seq = scene.header.seq  # counted by the publisher
        self.assertEqual(topics["scene"], scene)
        self.assertEqual(counter(scene, "views"), 1)
        self.assertEqual([p.id for p in scene.parts], list(range(5)))
        self.check_frames(scene, topics["points"])
        self.check_images(scene, topics)
        self.check_points_on_meshes(scene, topics)
        self.check_markers(scene, topics["markers"])

    # Lazy images

    def test_images_are_made_only_when_somebody_looks(self):
        scene = self.scene()
        self.assertEqual(counter(scene, "views"), 0)
        self.assertTrue(all(math.isnan(p.visible_fraction[0]) for p in scene.parts))
        late = Listener({"points": PointCloud2, "scene": Scene})
        try:
            late.wait(scene.header.stamp, ["points", "scene"])
            self.wait_until(lambda: counter(late.seen["scene"], "views") == 1)
            sent_again = late.seen["scene"]
        finally:
            late.close()
        self.assertEqual(sent_again.header.stamp, scene.header.stamp)
        self.assertEqual([p.pose for p in sent_again.parts], [p.pose for p in scene.parts])
        self.assertFalse(any(math.isnan(p.visible_fraction[0]) for p in sent_again.parts))
        asked = self.scene(render=True)
        self.assertEqual(counter(asked, "views"), 1)
        self.assertFalse(any(math.isnan(p.visible_fraction[0]) for p in asked.parts))

    def test_of_several_sensors_only_those_are_made_that_somebody_looks_at(self):
        self.scene(yaml=TWO_SENSORS)  # the topics are there from now on
        side = Listener({"side_view/points": PointCloud2, "scene": Scene})
        try:
            time.sleep(0.3)
            scene = self.scene(yaml=TWO_SENSORS)
            self.assertEqual(counter(scene, "views"), 1)
            for part in scene.parts:
                self.assertEqual([math.isnan(f) for f in part.visible_fraction], [True, False])
            side.wait(scene.header.stamp, ["side_view/points"])
            first = Listener({"depth/image_rect": Image})
            try:
                first.wait(scene.header.stamp, ["depth/image_rect"])
                self.wait_until(lambda: counter(side.seen["scene"], "views") == 2)
            finally:
                first.close()
        finally:
            side.close()

    def test_the_grey_image_is_made_when_somebody_looks_at_it(self):
        """After the depth image was made without it, or with it at once; both are one image."""
        yaml = REQUEST.replace("name: camera", "name: camera, model: structured_light")
        depth = Listener({"depth/image_rect": Image})
        seen = []
        try:
            scene = self.scene(yaml=yaml)
            before = depth.wait(scene.header.stamp, ["depth/image_rect"])["depth/image_rect"]
            for late in (True, False):
                gray = Listener({"gray/image_raw": Image, "scene": Scene})
                try:
                    if not late:
                        time.sleep(0.3)
                        scene = self.scene(yaml=yaml)
                    message = gray.wait(scene.header.stamp, ["gray/image_raw", "scene"])["gray/image_raw"]
                    time.sleep(0.3)  # the scene may be published again
                    self.assertEqual(counter(gray.seen["scene"], "views"), 2 if late else 1)
                finally:
                    gray.close()
                self.assertEqual((message.encoding, message.width, message.height), ("mono8", 240, 200))
                self.assertEqual(message.header.frame_id, "camera_optical_frame")
                seen.append(data.image_array(message))
            after = depth.wait(scene.header.stamp, ["depth/image_rect"])["depth/image_rect"]
        finally:
            depth.close()
        np.testing.assert_array_equal(seen[0], seen[1])
        self.assertEqual(before.data, after.data)
        self.assertGreater(seen[0].max(), 100)

    def test_a_late_subscriber_never_sees_an_older_scene(self):
        self.scene_on_topics(seed=[1])
        scene = self.scene(seed=[2])
        received = []
        subscriber = rospy.Subscriber("points", PointCloud2, lambda m: received.append(m.header.stamp))
        time.sleep(2.0)
        subscriber.unregister()
        self.assertEqual(received, [scene.header.stamp])

    # Several sensors, a bin of a mesh

    def test_every_sensor_has_topics_of_its_own(self):
        names = {"side_view/" + name: kind for name, kind in TOPICS.items() if name not in ("scene", "markers")}
        scene = self.scene(yaml=TWO_SENSORS)
        self.assertEqual([s.name for s in scene.sensors], ["camera", "side-view"])
        listener = Listener({**TOPICS, **names})
        try:
            topics = listener.wait(scene.header.stamp, {**TOPICS, **names})
            self.wait_until(lambda: counter(listener.seen["scene"], "views") == 2)
        finally:
            listener.close()
        for name in names:
            self.assertEqual(topics[name].header.frame_id, "side_view_optical_frame")
            self.assertEqual((topics[name].width, topics[name].height), (160, 120))
        for sensor in scene.sensors:
            truth = data.matrix(sensor.pose.position, sensor.pose.orientation)
            np.testing.assert_allclose(self.lookup(sensor.name.replace("-", "_") + "_optical_frame", scene.header.stamp), truth, atol=1e-12)
        # From above the nuts are seen; from the side the mug hides them, and is seen itself.
        fractions = np.array([p.visible_fraction for p in listener.seen["scene"].parts])
        self.assertEqual(fractions.shape, (2, 2))
        self.assertGreater(fractions[:, 0].max(), 0.5)
        np.testing.assert_array_equal(fractions[:, 1], 0.0)
        self.assertTrue(data.image_array(topics["labels/image_raw"]).any())
        self.assertFalse(data.image_array(topics["side_view/labels/image_raw"]).any())
        self.check_mug(scene, topics)
        self.scene()
        published = [name for name, _ in rospy.get_published_topics()]
        self.assertNotIn("/side_view/points", published)

    def check_mug(self, scene, topics):
        """The side camera's points, through TF alone, lie on the mug where the request and its marker put it."""
        bins = [m for m in topics["markers"].markers if m.ns == "bin"]
        self.assertEqual([os.path.basename(m.mesh_resource) for m in bins], ["mug.stl"])
        self.assertEqual((bins[0].pose.position.x, bins[0].scale.x), (0.01, 1e-3))
        cloud = topics["side_view/points"]
        points = data.cloud_array(cloud)
        points = data.xyz(points[np.isfinite(points["z"])])
        self.assertGreater(len(points), 200)
        some = points[np.random.RandomState(1).choice(len(points), 150, replace=False)]
        in_bin = data.moved(self.lookup(cloud.header.frame_id, scene.header.stamp), some)
        foot, _ = data.nearest_on_mesh(in_bin - [0.01, 0, 0], data.model("mug.stl"))
        self.assertLess(np.linalg.norm(in_bin - [0.01, 0, 0] - foot, axis=1).max(), TOLERANCE)

    # The same request, the same scene

    def test_typed_request_says_the_same_as_yaml(self):
        lines = [PartLine(model=m, unit="mm", count=n, density=7850) for m, n in zip(MODELS, (3, 2))]
        request = SceneRequest(seed=[7], parts=lines, solver="bullet",
                               sensors=[Sensor(name="camera", width=240, height=200)])
        request.bin.inner_size.x, request.bin.inner_size.y, request.bin.inner_size.z = 0.16, 0.14, 0.08
        typed, yaml = self.service(request).scene, self.scene()
        self.assertEqual(typed.request_sha256, yaml.request_sha256)
        self.assertEqual(typed.report.state_hash, yaml.report.state_hash)
        self.assertEqual([p.pose for p in typed.parts], [p.pose for p in yaml.parts])
        self.assertNotEqual(self.scene(seed=[8]).report.state_hash, yaml.report.state_hash)

    # Bad input

    def test_a_bad_request_is_an_error_and_the_node_lives(self):
        before = self.scene()
        for fields, text in (
                ({"yaml": "parts: []\nsolvr: {type: bullet}"}, "solver"),
                ({"yaml": "parts: [{model: nowhere.stl}]"}, "nowhere.stl"),
                ({"yaml": "parts: [{model: /etc/passwd}]"}, "/etc/passwd"),
                ({"file": "/etc/passwd", "yaml": ""}, "roots"),
                ({"set": ["parts[0].count=-3"]}, "count"),
                ({"yaml": REQUEST.replace(", unit: mm", "")}, "mm"),  # an implausible size: names the likely unit
        ):
            response = self.generate(**fields)
            self.assertFalse(response.success, fields)
            self.assertEqual(response.error_code.value, ErrorCode.INPUT, fields)
            self.assertIn(text, response.message)
            self.assertEqual(len(response.scene.parts), 0)
        latched = rospy.wait_for_message("scene", Scene, 5)
        self.assertEqual(latched.header.stamp, before.header.stamp)  # a failed call leaves the scene alone
        self.scene()

    def test_a_scene_that_fails_is_set_apart_with_its_reason(self):
        response = self.generate(set=["pour.limit=0.3"])
        self.assertFalse(response.scene.report.at_rest)
        self.assertFalse(response.success)
        self.assertEqual(response.error_code.value, ErrorCode.SET_APART)
        self.assertEqual(len(response.scene.parts), 5)
        self.assertTrue(response.scene.report.reasons)
        self.assertIn(response.scene.report.reasons[0], response.message)

    # Stale scenes

    def test_frames_of_an_older_scene_die(self):
        self.scene()
        self.lookup("part_0004", rospy.Time.now())
        smaller = self.scene(set=["parts[1].count=1"])
        self.assertEqual(len(smaller.parts), 4)
        self.lookup("part_0003", rospy.Time.now())
        with self.assertRaises(tf2_ros.TransformException):
            self.tf.lookup_transform("bin", "part_0004", rospy.Time.now(), rospy.Duration(0.5))

    def test_clear_empties_the_bin(self):
        before, topics = self.scene_on_topics()
        listener = Listener()
        time.sleep(0.3)
        self.assertTrue(self.clear().success)
        end = time.time() + 10
        while time.time() < end and listener.seen["scene"].header.stamp == before.header.stamp:
            time.sleep(0.02)
        stamp = listener.seen["scene"].header.stamp
        empty = listener.wait(stamp)
        listener.close()
        self.assertEqual(empty["scene"].parts, [])
        self.assertFalse(any(m.ns == "parts" for m in empty["markers"].markers))
        self.assertFalse(data.image_array(empty["labels/image_raw"]).any())
        self.assertTrue(np.isfinite(data.image_array(empty["depth/image_rect"])).any(), "the bin itself is still there")
        sent = []
        subscriber = rospy.Subscriber("/tf", TFMessage, sent.append)
        time.sleep(0.5)
        subscriber.unregister()
        self.assertEqual([t for message in sent for t in message.transforms], [])

    # Bags

    def test_the_tools_bag_is_a_recording_of_the_node(self):
        with tempfile.TemporaryDirectory() as folder:
            live = self.recording(os.path.join(folder, "live.bag"))
            request = os.path.join(folder, "request.yaml")
            models = os.environ["BIN_SCENES_MODELS"]
            with open(request, "w") as file:
                file.write(REQUEST.replace("model: ", "model: " + models + "/"))
            subprocess.run([rospy.get_param("/tool"), "generate", request, "--out", os.path.join(folder, "out"),
                            "--formats", "json,bag"], check=True, timeout=120)
            path = os.path.join(folder, "out", "scene_000000", "scene.bag")
            written = {}
            stamps = set()
            with rosbag.Bag(path) as bag:
                for name, message, time_written, header in bag.read_messages(return_connection_header=True):
                    written[name] = (message, header)
                    stamps.add(time_written)
                    if hasattr(message, "header"):
                        stamps.add(message.header.stamp)
            self.assertEqual({n: m._type for n, (m, _) in written.items()},
                             {n: m._type for n, (m, _) in live.items()})
            for name, (_, header) in written.items():
                for key in ("type", "md5sum", "message_definition", "latching"):
                    self.assertEqual(header.get(key, b"0"), live[name][1].get(key, b"0"), (name, key))
            self.assertEqual(len(stamps), 1)
            self.assertGreater(min(stamps).to_sec(), 1.7e9, "a time that tools take for one")
            poses = [[p.pose for p in m["/scene"][0].parts] for m in (written, live)]
            self.assertEqual(poses[0], poses[1])
            np.testing.assert_array_equal(data.image_array(written["/labels/image_raw"][0]),
                                          data.image_array(live["/labels/image_raw"][0]))
            subprocess.run([rospy.get_param("/tool"), "generate", request, "--out", os.path.join(folder, "cell"),
                            "--formats", "bag"], check=True, timeout=120, env=dict(os.environ, ROS_NAMESPACE="cell"))
            with rosbag.Bag(os.path.join(folder, "cell", "scene_000000", "scene.bag")) as bag:
                self.assertEqual(set(bag.get_type_and_topic_info().topics),
                                 {name if name in ("/tf", "/tf_static") else "/cell" + name for name in written})
            info = subprocess.run(["rosbag", "info", path], check=True, capture_output=True, text=True, timeout=60)
            self.assertIn("sensor_msgs/PointCloud2", info.stdout)

    def test_a_trace_as_a_bag_has_the_poses_of_the_table(self):
        with tempfile.TemporaryDirectory() as folder:
            request = os.path.join(folder, "request.yaml")
            with open(request, "w") as file:
                file.write(SMALL.replace("model: ", "model: " + os.environ["BIN_SCENES_MODELS"] + "/"))
            for name in ("trace.csv", "trace.bag"):
                subprocess.run([rospy.get_param("/tool"), "generate", request, "--out", os.path.join(folder, "out"),
                                "--seconds", "0.5", "--trace", os.path.join(folder, name)], timeout=120)
            table = {}
            with open(os.path.join(folder, "trace.csv")) as file:
                next(file)
                for line in file:
                    time_s, part, *values = map(float, line.split(","))
                    table.setdefault(time_s, {})["part_%04d" % part] = values[:7]
            sent = []
            with rosbag.Bag(os.path.join(folder, "trace.bag")) as bag:
                self.assertEqual(set(bag.get_type_and_topic_info().topics), {"/tf", "/tf_static", "/markers", "/contacts"})
                for _, message, stamp in bag.read_messages(topics=["/tf"]):
                    sent.append((stamp, {t.child_frame_id: t for t in message.transforms}))
                contacts = [(stamp, {m.ns: m for m in message.markers})
                            for _, message, stamp in bag.read_messages(topics=["/contacts"])]
                (_, meshes, _), = bag.read_messages(topics=["/markers"])
        self.assertEqual(len(sent), len(table))
        self.assertGreater(len(sent), 40)
        self.assertEqual([stamp for stamp, _ in contacts], [stamp for stamp, _ in sent])
        self.assertEqual({m.header.frame_id for m in meshes.markers if m.ns == "parts"}, set(sent[-1][1]))
        self.assertTrue(all(m.frame_locked for m in meshes.markers if m.ns == "parts"))
        self.assertEqual(len(contacts[0][1]["contact_points"].points), 0, "nothing touches at the start")
        last = contacts[-1][1]
        touching = len(last["contact_points"].points)
        self.assertGreater(touching, 0)
        self.assertEqual([len(last["contact_" + name].points) for name in ("normals", "forces")], 2 * [2 * touching])
        begin = int(sent[0][0].to_sec())
        for (stamp, transforms), (time_s, rows) in zip(sent, sorted(table.items())):
            self.assertAlmostEqual((stamp - rospy.Time(begin)).to_sec(), time_s, places=8)
            self.assertEqual(set(transforms), set(rows))
            for frame, values in rows.items():
                transform = transforms[frame]
                self.assertEqual((transform.header.frame_id, transform.header.stamp), ("bin", stamp))
                p, q = transform.transform.translation, transform.transform.rotation
                np.testing.assert_array_equal([p.x, p.y, p.z, q.x, q.y, q.z, q.w], values)

    def test_what_was_never_poured_is_in_no_frame_marker_or_label(self):
        with tempfile.TemporaryDirectory() as folder:
            request = os.path.join(folder, "request.yaml")
            model = os.path.join(os.environ["BIN_SCENES_MODELS"], "nut_hex.stl")
            with open(request, "w") as file:
                file.write("bin: {inner_size: [0.06, 0.05, 0.03]}\nsolver: {type: bullet}\nparts:\n"
                           "  - {model: %s, unit: mm, count: 40}\nsensors: [{width: 120, height: 100}]\n" % model)
            subprocess.run([rospy.get_param("/tool"), "generate", request, "--out", folder, "--formats", "bag",
                            "--set", "accept.escaped=true"], check=True, timeout=120)
            messages = {}
            with rosbag.Bag(os.path.join(folder, "scene_000000", "scene.bag")) as bag:
                for name, message, _ in bag.read_messages():
                    messages[name] = message
        parts = messages["/scene"].parts
        missing = set(messages["/scene"].report.not_poured)
        self.assertGreater(len(missing), 0)
        self.assertLess(len(missing), 40)
        self.assertEqual([p.id for p in parts], list(range(40)))
        there = {p.id for p in parts} - missing
        for part in parts:
            self.assertEqual(math.isfinite(part.pose.position.x), part.id in there)
        self.assertEqual({t.child_frame_id for t in messages["/tf"].transforms}, {"part_%04d" % i for i in there})
        self.assertEqual({m.id for m in messages["/markers"].markers if m.ns == "parts"}, there)
        seen = set(np.unique(data.image_array(messages["/labels/image_raw"]))) - {0}
        self.assertTrue(seen and seen <= {i + 1 for i in there})

    def recording(self, path):
        """{topic: (last message, connection header)} of a `rosbag record` while the node makes one scene."""
        topics = ["/tf", "/tf_static", "/acquisition_done"] + ["/" + name for name in TOPICS]
        recorder = subprocess.Popen(["rosbag", "record", "-q", "-O", path] + topics, start_new_session=True)
        try:
            self.wait_until(lambda: set(topics) <= self.connected_to("record"))
            scene = self.scene()
            time.sleep(1.0)
        finally:
            os.killpg(recorder.pid, signal.SIGINT)
            recorder.wait(20)
        self.wait_until(lambda: os.path.exists(path))  # the recorder renames it when all is written
        messages = {}
        with rosbag.Bag(path) as bag:
            for name, message, _, header in bag.read_messages(return_connection_header=True):
                messages[name] = (message, header)
        self.assertEqual(messages["/points"][0].header.stamp, scene.header.stamp)
        return messages

    @staticmethod
    def connected_to(node):
        """Topics that the node sends to another node with that in its name."""
        api = rospy.get_master().lookupNode("/bin_scenes")[2]
        connections = xmlrpc.client.ServerProxy(api).getBusInfo("/node_test")[2]
        return {c[4] for c in connections if c[2] == "o" and node in c[1]}


if __name__ == "__main__":
    rospy.init_node("node_test", anonymous=True)
    rostest.rosrun("bin_scenes", "node", NodeTest)
