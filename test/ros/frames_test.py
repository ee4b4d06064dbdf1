#!/usr/bin/python3
"""Part frames on /tf: whoever asks, whenever, at the scene's stamp; and nobody finds parts that are gone."""

import os
import subprocess
import sys
import time

import rospy
import rostest
import tf2_ros

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scene_client import CAMERA, SMALL, Doors, NodeTestCase, run, wait_until  # noqa: E402
from sensor_msgs.msg import PointCloud2  # noqa: E402

BUFFER = 2.0  # s: of the consumers here; ~tf_span of the node is 1 s, as 8 s go with the 10 s of a default buffer

LISTEN = """
import rospy, tf2_ros, time
rospy.init_node("listener", anonymous=True)
buffer = tf2_ros.Buffer()
listener = tf2_ros.TransformListener(buffer)
time.sleep(2.5)
print(bool(buffer.can_transform("bin", "part_0000", rospy.Time(0))))
"""

NEWCOMER = """
import rospy, sys
from sensor_msgs.msg import PointCloud2
rospy.init_node("newcomer", anonymous=True)
try:
    print(rospy.wait_for_message("points", PointCloud2, float(sys.argv[1])).header.stamp.to_nsec())
except rospy.ROSException:
    pass
"""


class Consumer:
    def __init__(self, seconds=BUFFER):
        self.tf = tf2_ros.Buffer(rospy.Duration(seconds))
        self.listener = tf2_ros.TransformListener(self.tf)

    def position(self, frame, stamp, seconds=3.0, parent="bin"):
        t = self.tf.lookup_transform(parent, frame, stamp, rospy.Duration(seconds)).transform.translation
        return (t.x, t.y, t.z)


def position(part):
    return (part.pose.position.x, part.pose.position.y, part.pose.position.z)


class FramesTest(NodeTestCase):
    @classmethod
    def setUpClass(cls):
        cls.doors = Doors()

    def test_a_consumer_finds_parts_at_the_scenes_stamp_however_late_it_comes(self):
        early = Consumer()
        scene = self.doors.scene(CAMERA)
        cloud = rospy.wait_for_message("points", PointCloud2, 20)
        self.assertEqual(cloud.header.stamp, scene.header.stamp)
        early.position("part_0000", scene.header.stamp)
        early.position("part_0000", scene.header.stamp + rospy.Duration(0.5))
        time.sleep(BUFFER + 2.0)
        late = Consumer()
        for consumer in (early, late):
            for part in scene.parts:
                for stamp in (cloud.header.stamp, rospy.Time(0)):
                    found = consumer.position(part.frame_id, stamp)
                    for a, b in zip(found, position(part)):
                        self.assertAlmostEqual(a, b, delta=1e-12)
            consumer.position(scene.parts[0].frame_id, cloud.header.stamp, parent=cloud.header.frame_id)

    def test_parts_that_are_gone_are_found_by_nobody(self):
        consumer, keeper = Consumer(), Consumer(seconds=60)
        before = self.doors.scene()
        consumer.position("part_0004", before.header.stamp)
        after = self.doors.scene(set=["parts[1].count=1"])
        consumer.position("part_0003", after.header.stamp)
        self.assert_gone(consumer, "part_0004", after.header.stamp)
        keeper.position("part_0004", before.header.stamp)  # what was true then still is
        self.assertTrue(self.doors.clear().success)
        wait_until(lambda: not consumer.tf.can_transform("bin", "part_0000", rospy.Time(0)))
        for part in after.parts:
            self.assert_gone(consumer, part.frame_id, rospy.Time.now())
        again = self.doors.scene()
        consumer.position("part_0004", again.header.stamp)
        consumer.position("part_0004", rospy.Time(0))

    def assert_gone(self, consumer, frame, stamp):
        for when in (rospy.Time(0), stamp):
            with self.assertRaises(tf2_ros.TransformException):
                consumer.position(frame, when, 0.3)

    def test_no_consumer_is_warned_of_repeated_or_old_data(self):
        self.doors.scene()
        time.sleep(1.5)  # the span is over
        listener = subprocess.Popen([sys.executable, "-c", LISTEN], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(1.0)
        self.doors.scene(SMALL, seed=[8])
        said = listener.communicate(timeout=30)
        self.assertIn("True", said[0])
        self.assertNotIn("TF_", "".join(said))

    def test_a_failed_call_leaves_frames_and_scene(self):
        consumer = Consumer()
        scene = self.doors.scene()
        response = self.doors.generate(self.request("parts: [{model: nowhere.stl}]"))
        self.assertFalse(response.success)
        response = self.doors.generate(self.request(SMALL + "pour: {limit: -1}"))
        self.assertFalse(response.success)
        late = Consumer()
        for who in (consumer, late):
            who.position("part_0004", scene.header.stamp)
            who.position("part_0004", rospy.Time(0))
        self.assertEqual(self.doors.latched().header.stamp, scene.header.stamp)

    @staticmethod
    def request(yaml):
        from bin_scenes.msg import SceneRequest
        return SceneRequest(yaml=yaml)

    # Clouds of an older scene

    def cloud_for_a_newcomer(self, seconds):
        """Stamp in ns of the cloud that a new process is handed, or None. rospy itself hands the last message of a latched
        topic to a second subscriber of the same process until it notices that the publisher has gone."""
        said = run(sys.executable, "-c", NEWCOMER, str(seconds))
        self.assertEqual(said.returncode, 0, said.stderr)
        return int(said.stdout) if said.stdout else None

    def test_no_cloud_is_left_of_a_scene_that_is_gone(self):
        clouds = []
        listener = rospy.Subscriber("points", PointCloud2, clouds.append)
        first = self.doors.scene(CAMERA)
        wait_until(lambda: clouds and clouds[-1].header.stamp == first.header.stamp)
        self.doors.scene(SMALL)  # no sensor
        count = len(clouds)
        self.assertIsNone(self.cloud_for_a_newcomer(1.5))
        self.assertEqual(len(clouds), count)
        second = self.doors.scene(CAMERA)
        wait_until(lambda: clouds[-1].header.stamp == second.header.stamp)
        self.assertEqual(self.cloud_for_a_newcomer(5), second.header.stamp.to_nsec())
        self.assertTrue(self.doors.clear().success)
        empty = self.doors.latched()
        self.assertEqual(empty.parts, [])
        self.assertEqual(self.cloud_for_a_newcomer(5), empty.header.stamp.to_nsec())
        listener.unregister()
        self.doors.scene(SMALL)
        self.assertTrue(self.doors.clear().success)
        self.assertIsNone(self.cloud_for_a_newcomer(1.5))

    # Names of sensors

    def test_topics_of_a_sensor_do_not_depend_on_the_order(self):
        sensors = ["{name: left, width: 60, height: 50}", "{name: side-2, width: 60, height: 50}"]
        published = []
        for order in (sensors, sensors[::-1]):
            scene = self.doors.scene(SMALL + "sensors: [%s]" % ", ".join(order))
            names = {name for name, kind in rospy.get_published_topics() if kind == "sensor_msgs/PointCloud2"}
            published.append(names)
            cloud = rospy.wait_for_message("side_2/points", PointCloud2, 20)
            self.assertEqual(cloud.header.frame_id, "side_2_optical_frame")
            self.assertEqual(cloud.header.stamp, scene.header.stamp)
        self.assertEqual(published, [{"/left/points", "/side_2/points"}] * 2)
        self.doors.scene(SMALL + "sensors: [%s]" % sensors[1])  # a single one has the plain names
        self.assertEqual(rospy.wait_for_message("points", PointCloud2, 20).header.frame_id, "side_2_optical_frame")


if __name__ == "__main__":
    rospy.init_node("frames_test", anonymous=True)
    rostest.rosrun("bin_scenes", "frames", FramesTest)
