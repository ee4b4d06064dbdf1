#!/usr/bin/python3
"""Wrong parameters end the node with a reason; what a user types first works."""

import os
import signal
import subprocess
import sys

import rospkg
import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scene_client import Doors, NodeTestCase, run  # noqa: E402
from bin_scenes.msg import ErrorCode, SceneRequest  # noqa: E402

WRONG = {
    "bin_pose": ([0, 0, 1], "text", [0, 0, 0, 0, 0, 0, 0]),
    "tf_rate": (0, -1, "fast"),
    "tf_span": (-1,),
    "publish_rate": (-1, 1e6),
    "model_roots": ("text", [], ["/nowhere"]),
    "bin_frame": ("", 7, "/bin", "my bin"),
    "parent_frame": ("bin",),
    "queue_size": (0, 10 ** 6),
    "scenes_ahead": (-1,),
    "goals": ("pile",),
    "bins": ("left", ["no good"]),
    "request": (7,),
    "finish": ("bogus", 1),
    "solver": ("bogus",),
    "noise": ("loud",),
}


class ParametersTest(NodeTestCase):
    def test_a_wrong_parameter_ends_the_node_with_a_reason(self):
        cases = [(parameter, value) for parameter, values in WRONG.items() for value in values]
        for i, (parameter, value) in enumerate(cases):
            rospy.set_param("wrong_%d/%s" % (i, parameter), value)
            ended = run(rospy.get_param("/node"), "__name:=wrong_%d" % i)
            said = ended.stdout + ended.stderr
            self.assertEqual(ended.returncode, 2, (parameter, value, said))
            self.assertIn("parameter /wrong_%d/%s" % (i, parameter), said)

    def test_a_signal_ends_the_node_in_order(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            name = "ended_by_%d" % number
            node = subprocess.Popen([rospy.get_param("/node"), "__name:=" + name, "__ns:=ended"])
            try:
                Doors("/ended/")
                node.send_signal(number)
                self.assertEqual(node.wait(10), 0, name)
                # It has told the master, which a process that is killed does not.
                self.assertEqual(rospy.get_master().lookupNode("/ended/" + name)[0], -1)
            finally:
                node.kill()

    def test_rosrun_finds_the_node(self):
        rospy.set_param("found/tf_rate", 0)
        ended = run("rosrun", "bin_scenes", "bin_scenes_node", "__name:=found")
        self.assertIn("parameter /found/tf_rate", ended.stdout + ended.stderr)

    # Paths

    def refusal(self, **fields):
        response = Doors().generate(SceneRequest(**fields))
        self.assertEqual((response.success, response.error_code.value), (False, ErrorCode.INPUT), fields)
        return response.message

    def test_request_files_and_models_are_found_in_any_root(self):
        doors = Doors()
        small = ["parts[0].count=1", "solver.type=bullet"]
        self.assertTrue(doors.generate(SceneRequest(file="conrods.yaml", set=small)).success)
        yaml = "parts: [{model: %s, unit: mm, count: 1}]\nsolver: {type: bullet}"
        for model in ("nut_hex.stl", "conrod.stl", "package://bin_scenes/models/nut_hex.stl"):
            self.assertTrue(doors.generate(SceneRequest(yaml=yaml % model)).success, model)

    def test_a_refused_path_names_the_parameter(self):
        for fields in ({"file": "/etc/passwd"}, {"yaml": "parts: [{model: /etc/passwd}]"},
                       {"yaml": "parts: [{model: ../package.xml}]"}, {"yaml": "parts: [{model: nowhere.stl}]"}):
            self.assertIn("model_roots", self.refusal(**fields), fields)

    def test_packages_are_those_of_rospack(self):
        self.assertIn("package 'nowhere_at_all'", self.refusal(yaml="parts: [{model: package://nowhere_at_all/a.stl}]"))
        # Found, but outside of the roots.
        package = "roscpp" if "roscpp" in rospkg.RosPack().list() else "rostest"
        self.assertIn("model_roots", self.refusal(yaml="parts: [{model: package://%s/package.xml}]" % package))

    def test_no_argument_of_a_launch_file_is_required(self):
        folder = os.path.join(rospkg.RosPack().get_path("bin_scenes"), "launch")
        for name in sorted(os.listdir(folder)):
            told = run("roslaunch", "--ros-args", os.path.join(folder, name))
            self.assertEqual(told.returncode, 0, name + told.stderr)
            self.assertNotIn("Required", told.stdout, name)


if __name__ == "__main__":
    rospy.init_node("parameters_test", anonymous=True)
    rostest.rosrun("bin_scenes", "parameters", ParametersTest)
