#!/usr/bin/python3
"""Each launch file, started as a user starts it: `roslaunch bin_scenes NAME.launch`. demo_test.py has that with RViz."""

import glob
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

import numpy as np
import rosbag
import rospkg
import rospy
import rostest
import tf2_ros
from sensor_msgs.msg import PointCloud2

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_data as data  # noqa: E402
from launched import LaunchTestCase, Launched  # noqa: E402
from scene_client import CAMERA, Doors, run, wait_until  # noqa: E402


def mcap_summary(path):
    """(profile, {topic: (type, number of messages)}) as the summary at the end of an MCAP file tells; see mcap.dev."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == data[-8:] == b"\x89MCAP0\r\n"

    def text(at):
        return data[at + 4:at + 4 + struct.unpack_from("<I", data, at)[0]].decode()

    at, = struct.unpack_from("<Q", data, len(data) - 28)
    schemas, channels, counts = {}, {}, {}
    while data[at] in range(0x03, 0x0e):
        op, size = data[at], struct.unpack_from("<Q", data, at + 1)[0]
        content = at + 9
        if op == 0x03:
            schemas[struct.unpack_from("<H", data, content)[0]] = text(content + 2)
        if op == 0x04:
            number, schema = struct.unpack_from("<HH", data, content)
            channels[number] = (text(content + 4), schemas[schema])
        if op == 0x0b:
            length = struct.unpack_from("<I", data, content + 42)[0]
            counts = dict(struct.iter_unpack("<HQ", data[content + 46:content + 46 + length]))
        at = content + size
    return text(17), {topic: (kind, counts[number]) for number, (topic, kind) in channels.items()}


class LaunchTest(LaunchTestCase):
    def test_bin_scenes(self):
        with Launched("bin_scenes.launch", "request:=" + self.request, "parent_frame:=cell", "bin_pose:=[0, 0, 1, 0, 0, 0, 1]"):
            self.assertEqual(len(self.first_scene().parts), 5)
            tf = tf2_ros.Buffer()
            tf2_ros.TransformListener(tf)
            self.assertEqual(tf.lookup_transform("cell", "bin", rospy.Time(0), rospy.Duration(10)).transform.translation.z, 1.0)

    def test_nodelet(self):
        with Launched("nodelet.launch", "request:=" + self.request):
            self.assertEqual(len(self.first_scene().parts), 5)
            cloud = rospy.wait_for_message("points", PointCloud2, 20)
            self.assertEqual(cloud.header.stamp, self.first_scene().header.stamp)

    def test_depth_image_proc(self):
        # Debian's pcl_ros names its libraries as if they lay in a folder lib below a prefix.
        prefix = os.path.join(self.folder.name, "prefix")
        os.mkdir(prefix)
        for library in glob.glob("/usr/lib/*/libpcl_ros_filters.so"):
            os.symlink(os.path.dirname(library), os.path.join(prefix, "lib"))
        environment = {**os.environ, "CMAKE_PREFIX_PATH": os.environ["CMAKE_PREFIX_PATH"] + ":" + prefix}
        with Launched("depth_image_proc.launch", "request:=" + self.request, environment=environment):
            made = data.xyz(data.cloud_array(rospy.wait_for_message("depth/points", PointCloud2, 60)))
            ours = data.xyz(data.cloud_array(rospy.wait_for_message("points", PointCloud2, 20)))
            np.testing.assert_allclose(made, ours, rtol=1e-6, atol=1e-6)
            # A nodelet of pcl_ros in the same manager takes the cloud as it is; both get what they listen to without a copy.
            load = ["rosrun", "nodelet", "nodelet", "load", "pcl/PassThrough", "bin_manager", "~input:=points",
                    "~output:=near/points", "_filter_field_name:=z", "_filter_limit_min:=0.0", "_filter_limit_max:=10.0"]
            passed = subprocess.Popen(load)
            try:
                near = rospy.wait_for_message("near/points", PointCloud2, 30)
                self.assertEqual([f.name for f in near.fields][:3], ["x", "y", "z"])
                # Both nodelets listen only while somebody listens to them.
                listeners = [rospy.Subscriber(name, PointCloud2, lambda _: None) for name in ("near/points", "depth/points")]
                for topic in ("/points", "/depth/image_rect"):
                    wait_until(lambda: {t for name, t in self.links("/bin_manager") if name == topic} == {"INTRAPROCESS"})
                for listener in listeners:
                    listener.unregister()
            finally:
                passed.send_signal(signal.SIGINT)
                passed.wait()

    @staticmethod
    def links(node):
        """(topic, transport) of what a node publishes or hears, as `rosnode info` lists it."""
        import xmlrpc.client
        return [(link[4], link[3]) for link in xmlrpc.client.ServerProxy(
            rospy.get_master().lookupNode(node)[2]).getBusInfo("/test")[2]]

    def test_record(self):
        with Launched("bin_scenes.launch"):
            doors = Doors()
            with Launched("record.launch", "bag:=" + os.path.join(self.folder.name, "recorded"), "gray:=true") as recorder:
                wait_until(self.recorder_listens, 60)
                # A recorder of another node's topics leaves the first one alone.
                with Launched("record.launch", "bag:=" + os.path.join(self.folder.name, "other"), "space:=/other/"):
                    wait_until(lambda: self.recorder_listens("/other/validity/image_raw"), 60)
                    scene = doors.scene(CAMERA.replace("name: camera", "name: camera, model: image"))
                    time.sleep(1.0)
        pattern = os.path.join(self.folder.name, "recorded*.bag")
        try:
            wait_until(lambda: glob.glob(pattern), 20)  # roslaunch may end before rosbag has closed its file
        except AssertionError:
            self.fail("no bag among %s; the recorder said:\n%s" % (os.listdir(self.folder.name), recorder.output()))
        with rosbag.Bag(glob.glob(pattern)[0]) as bag:
            found = bag.get_type_and_topic_info().topics
            for topic in ("/scene", "/markers", "/points", "/depth/image_rect", "/depth/camera_info", "/labels/image_raw",
                          "/validity/image_raw", "/gray/image_raw", "/image_raw", "/camera_info", "/acquisition_done", "/tf", "/tf_static"):
                self.assertIn(topic, found)
            stamps = {m.header.stamp for _, m, _ in bag.read_messages(["/scene", "/points", "/labels/image_raw", "/gray/image_raw", "/image_raw"])}
        self.assertEqual(stamps, {scene.header.stamp})

    def test_record_mcap(self):
        """The recorder of MCAP has the topics of rosbag, for either ROS; a format that is none is refused."""
        for profile, cloud in (("ros1", "sensor_msgs/PointCloud2"), ("ros2", "sensor_msgs/msg/PointCloud2")):
            prefix = os.path.join(self.folder.name, profile)
            with Launched("bin_scenes.launch"):
                doors = Doors()
                with Launched("record.launch", "bag:=" + prefix, "bag_format:=mcap", "mcap:=" + profile) as recorder:
                    wait_until(self.recorder_listens, 60)
                    doors.scene(CAMERA)
                    time.sleep(1.0)
                    self.assertEqual(glob.glob(prefix + "*"), [], "a file that is still written has no name")
            files = glob.glob(prefix + "*.mcap")
            self.assertEqual(len(files), 1, recorder.output())
            found_profile, channels = mcap_summary(files[0])
            self.assertEqual(found_profile, profile)
            for topic in ("/scene", "/markers", "/points", "/depth/image_rect", "/depth/camera_info", "/labels/image_raw",
                          "/validity/image_raw", "/acquisition_done", "/tf", "/tf_static"):
                self.assertGreater(channels[topic][1], 0, topic)
            self.assertEqual(channels["/points"][0], cloud)
            self.assertNotIn("Traceback", recorder.output())
        refused = subprocess.run(["roslaunch", "bin_scenes", "record.launch", "bag_format:=zip"], capture_output=True, text=True,
                                 timeout=60)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("zip", refused.stderr + refused.stdout)
        refused = run("rosrun", "bin_scenes", "record", "-o", os.path.join(self.folder.name, "refused"), "/my-cell/points")
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("/my-cell/points", refused.stderr)
        self.assertEqual(glob.glob(os.path.join(self.folder.name, "*refused*")), [])

    @staticmethod
    def recorder_listens(topic="/validity/image_raw"):
        _, subscribed, _ = rospy.get_master().getSystemState()[2]
        return any(name == topic and nodes for name, nodes in subscribed)

    def test_icp_check(self):
        """ICP of what the camera sees ends where TF says that the parts are, and nothing had to be remapped."""
        rospy.set_param("/bin_scenes/frame_prefix", "left/")
        with Launched("icp_check.launch", "request:=" + self.request) as launched:
            tf = tf2_ros.Buffer()
            tf2_ros.TransformListener(tf)
            scene = self.first_scene()
            wait_until(lambda: "5 of 5 parts" in launched.output(), 60)
            cloud = rospy.wait_for_message("points", PointCloud2, 20)
            labels = data.cloud_array(cloud)["label"]
            seen = [p for p in scene.parts if np.count_nonzero(labels == p.id + 1) > 1500]
            self.assertGreaterEqual(len(seen), 3)
            for part in seen:
                # From the part's true frame to the one that ICP found.
                apart = tf.lookup_transform(part.frame_id, "icp_" + part.frame_id, cloud.header.stamp, rospy.Duration(5)).transform
                t, q = apart.translation, apart.rotation
                self.assertLess(np.linalg.norm([t.x, t.y, t.z]), 5e-4, part.frame_id)  # m; the guess is 2e-3 away
                self.assertLess(2 * np.linalg.norm([q.x, q.y, q.z]), 0.01, part.frame_id)  # rad; likewise 0.03


    def test_icp_check_with_a_sensor_that_misses_much(self):
        """Segments of a noisy sensor that ICP cannot place are a result; models may come from anywhere."""
        models = tempfile.mkdtemp(dir=self.folder.name)
        shutil.copy(os.path.join(rospkg.RosPack().get_path("bin_scenes"), "models/ring_24.stl"), models)
        request = os.path.join(tempfile.mkdtemp(dir=self.folder.name), "rings.yaml")
        with open(request, "w") as file:
            file.write("""
seed: 1
bin: {inner_size: [0.2, 0.15, 0.1]}
parts: [{model: ring_24.stl, unit: mm, count: 10}]
solver: {type: bullet}
sensors: [{name: camera, model: structured_light, width: 640, height: 480, fov: 0.6, projector: {baseline: 0.15, fov: 0.8}}]
""")
        with Launched("icp_check.launch", "request:=" + request, "model_roots:=[%s]" % models, "least_points:=3",
                      "offset:=0.05") as launched:
            wait_until(lambda: "parts with at least 3 points" in launched.output(), 120)
            said = launched.output()
        self.assertNotIn("exit code", said, "icp_check has died")
        checked, found = (int(n) for n in re.search(r"(\d+) of (\d+) parts with at least 3 points", said).groups())
        self.assertGreaterEqual(found, 8)
        self.assertGreater(said.count("did not converge"), 0)
        self.assertIn("%d did not converge" % said.count("points, ICP did not converge"), said)


if __name__ == "__main__":
    rospy.init_node("launch_test", anonymous=True)
    rostest.rosrun("bin_scenes", "launch", LaunchTest)
