#!/usr/bin/python3
"""The node under use_sim_time: without a clock, when it begins, stands still, and jumps back."""

import os
import sys
import time

import dynamic_reconfigure.client
import rospy
import rostest
import tf2_ros
from rosgraph_msgs.msg import Clock, Log

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scene_client import CAMERA, Doors, NodeTestCase, wait_until  # noqa: E402
from bin_scenes.msg import Scene  # noqa: E402
from sensor_msgs.msg import PointCloud2  # noqa: E402


class ClockTest(NodeTestCase):
    def test_stamps_follow_the_clock(self):
        doors = Doors()
        clock = rospy.Publisher("/clock", Clock, queue_size=1)
        scenes, clouds = [], []
        rospy.Subscriber("scene", Scene, scenes.append)
        warnings = []
        rospy.Subscriber("/rosout", Log, lambda log: warnings.append(log) if "no clock runs" in log.msg else None)
        rospy.Subscriber("points", PointCloud2, clouds.append)
        tf = tf2_ros.Buffer(rospy.Duration(10))
        tf2_ros.TransformListener(tf)

        def shown_near(seconds):
            """All topics show the scene under one stamp near that time of the clock, and its parts are found."""
            def there():
                clock.publish(Clock(rospy.Time.from_sec(seconds)))
                stamp = scenes[-1].header.stamp
                return (abs(stamp.to_sec() - seconds) < 1.0 and clouds and clouds[-1].header.stamp == stamp
                        and tf.can_transform("bin", "part_0004", stamp)
                        and tf.can_transform("bin", "part_0004", rospy.Time(0)))
            wait_until(there, 20, "at %s: scene %s, cloud %s" % (
                seconds, scenes[-1].header.stamp if scenes else None, clouds[-1].header.stamp if clouds else None))
            return scenes[-1].header.stamp

        # No clock yet: a scene all the same, under a stamp that is not "no time".
        first = doors.scene(CAMERA)
        wait_until(lambda: scenes and scenes[-1].header.stamp == first.header.stamp)
        self.assertGreater(first.header.stamp, rospy.Time(0))
        self.assertLess(first.header.stamp, rospy.Time(1))
        wait_until(lambda: tf.can_transform("bin", "part_0004", first.header.stamp))
        # That is told once, however often the scene is published again.
        config = dynamic_reconfigure.client.Client("bin_scenes", timeout=30)
        config.update_configuration({"publish_rate": 50.0})
        wait_until(lambda: len({scene.header.stamp for scene in scenes}) > 5)
        config.update_configuration({"publish_rate": 0.0})
        wait_until(lambda: warnings)
        self.assertEqual(len(warnings), 1)
        # It begins, late.
        shown_near(1000.0)
        self.assertEqual(scenes[-1].parts[0].pose, first.parts[0].pose)
        # It stands still: two scenes have different stamps.
        one, two = doors.scene(CAMERA), doors.scene(CAMERA, seed=[8])
        self.assertGreater(two.header.stamp, one.header.stamp)
        wait_until(lambda: tf.can_transform("bin", "part_0004", two.header.stamp))
        found = tf.lookup_transform("bin", "part_0004", rospy.Time(0)).transform.translation
        self.assertAlmostEqual(found.x, two.parts[4].pose.position.x, delta=1e-12)
        # It jumps back, as when a bag is played again.
        time.sleep(0.3)
        shown_near(500.0)
        shown_near(3.0)
        self.assertEqual(scenes[-1].parts[4].pose, two.parts[4].pose)


if __name__ == "__main__":
    rospy.init_node("clock_test", anonymous=True)
    rostest.rosrun("bin_scenes", "clock", ClockTest)
