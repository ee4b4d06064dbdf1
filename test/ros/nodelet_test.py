#!/usr/bin/python3
"""The nodelet serves as the node does; parameters change live; diagnostics tell what goes on."""

import os
import sys

import dynamic_reconfigure.client
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scene_client import CAMERA, SMALL, Client, Doors, NodeTestCase, run, wait_until  # noqa: E402
from sensor_msgs.msg import PointCloud2  # noqa: E402
from std_msgs.msg import Header  # noqa: E402


class NodeletTest(NodeTestCase):
    @classmethod
    def setUpClass(cls):
        cls.doors = Doors()
        cls.said = {}
        rospy.Subscriber("/diagnostics", DiagnosticArray, cls.hear)

    @classmethod
    def hear(cls, array):
        for status in array.status:
            cls.said[status.name.split(": ")[-1]] = status

    def test_topics_action_and_services_are_those_of_the_node(self):
        events = []
        rospy.Subscriber("acquisition_done", Header, events.append)
        early = []
        subscriber = rospy.Subscriber("points", PointCloud2, early.append)
        scene = self.doors.scene(CAMERA)
        wait_until(lambda: early and early[-1].header.stamp == scene.header.stamp)
        subscriber.unregister()
        late = rospy.wait_for_message("points", PointCloud2, 20)  # kept for late subscribers, as if it were latched
        self.assertEqual((late.header.stamp, late.data), (scene.header.stamp, early[-1].data))
        wait_until(lambda: events and events[-1].stamp == scene.header.stamp)
        self.assertTrue(Client().send(SMALL).result()[1].success)
        with self.assertRaises(rospy.ROSException):
            rospy.wait_for_message("points", PointCloud2, 1.0)  # no sensor, no cloud
        self.assertTrue(self.doors.pick(ids=[1]).success)

    def test_diagnostics_tell_of_every_concern(self):
        self.doors.scene()
        wait_until(lambda: {"device", "scene", "queue", "cache", "memory", "sensors"} <= set(self.said))
        wait_until(lambda: "accepted" in self.said["scene"].message)
        self.assertEqual(self.said["scene"].name, "bin_scenes: scene", "its own name, not that of the manager")
        self.assertEqual(self.said["scene"].level, DiagnosticStatus.OK)
        self.assertIn("bullet", self.said["device"].message)
        for _ in range(3):
            self.doors.generate(self.request(set=["pour.limit=0.3"]))
        wait_until(lambda: self.said["scene"].level == DiagnosticStatus.ERROR)
        self.doors.scene()
        wait_until(lambda: self.said["scene"].level == DiagnosticStatus.OK)

    @staticmethod
    def request(**fields):
        from bin_scenes.msg import SceneRequest
        return SceneRequest(yaml=SMALL, **fields)

    def test_parameters_change_live(self):
        config = dynamic_reconfigure.client.Client("bin_scenes", timeout=30)
        self.assertEqual(self.doors.scene(SMALL.replace("bullet", "sphere")).report.finish, "probed")
        config.update_configuration({"finish": "settled", "publish_rate": 10.0})
        first = self.doors.scene(SMALL.replace("bullet", "sphere"))
        self.assertEqual(first.report.finish, "settled")
        self.assertEqual(self.doors.scene(SMALL.replace("bullet", "sphere"), set=["pour.finish=pressed"]).report.finish,
                         "pressed")
        stamps = set()
        wait_until(lambda: stamps.add(self.doors.latched().header.stamp) or len(stamps) > 2)
        for name in ("finish", "solver"):  # refused: what was set stays, and later scenes are made
            answered = config.update_configuration({name: "bogus"})
            self.assertEqual(answered[name], {"finish": "settled", "solver": "request"}[name])
        self.assertEqual(self.doors.scene(SMALL.replace("bullet", "sphere")).report.finish, "settled")
        config.update_configuration({"finish": "request", "publish_rate": 0.0})
        self.assertEqual(config.update_configuration({"tf_rate": 1e9})["tf_rate"], 1000.0)

    def test_several_bins_are_refused(self):
        rospy.set_param("/several/bins", ["left", "right"])
        ended = run("rosrun", "nodelet", "nodelet", "load", "bin_scenes/scenes", "bin_manager", "__name:=several")
        self.assertNotEqual(ended.returncode, 0)
        self.assertTrue(self.doors.scene().parts)

    def test_messages_are_documented(self):
        shown = run("rosmsg", "show", "-r", "bin_scenes/GenerateSceneFeedback").stdout + run(
            "rossrv", "show", "-r", "bin_scenes/PickPart").stdout
        for word in ("wall-clock time", "bin frame", "bit for bit"):
            self.assertIn(word, shown)


if __name__ == "__main__":
    rospy.init_node("nodelet_test", anonymous=True)
    rostest.rosrun("bin_scenes", "nodelet", NodeletTest)
