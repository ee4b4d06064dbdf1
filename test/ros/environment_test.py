#!/usr/bin/python3
"""What the node needs goes away and comes back: the master, and OpenGL."""

import glob
import os
import signal
import socket
import subprocess
import sys
import tempfile

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from bin_scenes.msg import ErrorCode, SceneRequest  # noqa: E402
from scene_client import Doors, NodeTestCase, run, wait_until  # noqa: E402
from diagnostic_msgs.msg import DiagnosticArray  # noqa: E402
from rosgraph_msgs.msg import Log  # noqa: E402
from sensor_msgs.msg import PointCloud2  # noqa: E402

ONE = "{parts: [{model: nut_hex.stl, unit: mm, count: 1}], solver: {type: sphere}}"
DRIVERS = glob.glob("/usr/lib/*/dri/*_dri.so")


class Process:
    def __init__(self, *command, **environment):
        self.process = subprocess.Popen(command, env={**os.environ, **environment})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


def masters_of_our_own():
    """Environment of a port that is free; what a command says there; and a master that is started there."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    there = {"ROS_MASTER_URI": "http://127.0.0.1:%d" % port}

    def asked(*command):
        return run(*command, env={**os.environ, **there}).stdout

    def master():
        started = Process("rosmaster", "--core", "-p", str(port))
        wait_until(lambda: asked("rostopic", "list") != "", 30)
        return started
    return there, asked, master


class EnvironmentTest(NodeTestCase):
    def test_a_master_that_is_started_again_finds_the_node(self):
        there, asked, master = masters_of_our_own()
        call = ["rosservice", "call", "/generate_scene", "request: {yaml: '%s'}" % ONE]
        stamp = ["rostopic", "echo", "-n1", "/scene/header/stamp"]
        with master() as first, Process(rospy.get_param("/node"), "__name:=bin_scenes", **there) as node:
            wait_until(lambda: "/generate_scene" in asked("rosservice", "list"), 30)
            self.assertIn("success: True", asked(*call))
            before = asked(*stamp)
            first.process.send_signal(signal.SIGKILL)
            first.process.wait()
            with master():
                wait_until(lambda: "/generate_scene" in asked("rosservice", "list"), 30)
                self.assertIsNone(node.process.poll())
                wait_until(lambda: "/scene" in asked("rostopic", "list").split(), 30)
                self.assertEqual(asked(*stamp), before)  # the scene stands
                self.assertIn("success: True", asked(*call))
                self.assertNotEqual(asked(*stamp), before)
                # Subscriptions too: the action hears of goals that are sent by a node which came after the master.
                self.assertIn("/bin_scenes", asked("rostopic", "info", "/generate/goal"))

    def test_who_publishes_before_the_node_is_back_is_heard(self):
        there, asked, master = masters_of_our_own()
        goal = ("rostopic", "pub", "/generate/goal", "bin_scenes/GenerateSceneActionGoal",
                "goal: {request: {yaml: '%s'}}" % ONE)
        with master() as first, Process(rospy.get_param("/node"), "__name:=bin_scenes", **there) as node:
            wait_until(lambda: "/generate/goal" in asked("rostopic", "list"), 30)
            node.process.send_signal(signal.SIGSTOP)  # the master and the publisher are there first
            first.process.send_signal(signal.SIGKILL)
            first.process.wait()
            with master(), Process(*goal, **there):
                wait_until(lambda: "/rostopic" in asked("rostopic", "info", "/generate/goal"), 30)
                node.process.send_signal(signal.SIGCONT)
                wait_until(lambda: "/scene" in asked("rostopic", "list").split(), 30)
                self.assertIn("secs", asked("timeout", "20", "rostopic", "echo", "-n1", "/scene/header/stamp"))

    def test_without_opengl_the_node_serves_what_needs_none_and_tries_again_when_asked(self):
        self.assertTrue(DRIVERS)
        gpu = SceneRequest(yaml=ONE, set=["solver.sphere.device=gpu"])
        with tempfile.TemporaryDirectory() as folder, Process(
                rospy.get_param("/node"), "__name:=bin_scenes", LIBGL_DRIVERS_PATH=folder, BIN_SCENES_GL="software"):
            doors = Doors()
            for _ in range(2):
                response = doors.generate(gpu)
                self.assertEqual((response.success, response.error_code.value), (False, ErrorCode.ENVIRONMENT))
                self.assertIn("no OpenGL 4.5 device", response.message)
                self.assertIn("apt install", response.message)
                scene = doors.scene(ONE)
                self.assertEqual(doors.latched().header.stamp, scene.header.stamp)
            for driver in DRIVERS:
                os.symlink(driver, os.path.join(folder, os.path.basename(driver)))
            response = doors.generate(gpu)
            self.assertTrue(response.success, response.message)
            self.assertIn("llvmpipe", response.scene.report.device)

    def test_opengl_that_is_lost_in_the_middle_costs_that_scene_and_no_other(self):
        gpu = SceneRequest(yaml=ONE, set=["solver.sphere.device=gpu"])
        with tempfile.TemporaryDirectory() as folder:
            lose = os.path.join(folder, "lose")
            with Process(rospy.get_param("/node"), "__name:=bin_scenes", BIN_SCENES_GL="software",
                         LD_PRELOAD=rospy.get_param("/lost_gl"), LOSE_GL=lose):
                doors = Doors()
                whole = doors.generate(gpu)
                self.assertTrue(whole.success, whole.message)
                poses = [part.pose for part in whole.scene.parts]
                for _ in range(2):
                    open(lose, "w").close()
                    response = doors.generate(gpu)
                    self.assertEqual((response.success, response.error_code.value), (False, ErrorCode.ENVIRONMENT))
                    self.assertIn("lost", response.message)
                    self.assertFalse(os.path.exists(lose))
                    self.assertEqual(doors.latched().header.stamp, whole.scene.header.stamp)
                    whole = doors.generate(gpu)
                    self.assertTrue(whole.success, whole.message)
                    self.assertEqual([part.pose for part in whole.scene.parts], poses)
                self.assertTrue(doors.generate(SceneRequest(yaml=ONE)).success)

    def test_a_picture_that_is_gone_is_told_once_a_scene_not_at_each_publication(self):
        with tempfile.TemporaryDirectory() as folder:
            sky = os.path.join(folder, "sky.hdr")
            with open(sky, "wb") as file:
                file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + 2 * b"\x40\x40\x40\x81")
            rospy.set_param("/bin_scenes", {"model_roots": [os.environ["BIN_SCENES_MODELS"], folder], "publish_rate": 20})
            self.addCleanup(rospy.delete_param, "/bin_scenes")
            log, said = [], {}
            rospy.Subscriber("/rosout", Log, lambda message: log.append(message.msg))
            rospy.Subscriber("/diagnostics", DiagnosticArray, lambda array: said.update(
                (s.name, {v.key: v.value for v in s.values}) for s in array.status))
            yaml = ONE[:-1] + (", sensors: [{name: camera, model: image, width: 16, height: 12, "
                               "lamps: [{type: dome, picture: sky.hdr}]}]}")
            with Process(rospy.get_param("/node"), "__name:=bin_scenes"):
                doors = Doors()
                wait_until(lambda: doors.scene(yaml) and any("scene 0 of seed" in line for line in log))
                os.remove(sky)
                rospy.Subscriber("points", PointCloud2, lambda _: None)
                wait_until(lambda: int(said.get("bin_scenes: sensors", {}).get("failures since the last scene", 0)) > 2)
            self.assertEqual(len([line for line in log if line.startswith("no image: ")]), 1, log)


if __name__ == "__main__":
    rospy.init_node("environment_test", anonymous=True)
    rostest.rosrun("bin_scenes", "environment", EnvironmentTest)
