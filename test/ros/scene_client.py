"""What the tests of the node have in common: a client of all of its doors."""

import os
import subprocess
import sys
import threading
import time
import unittest

import actionlib
import rospy
import std_srvs.srv

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from bin_scenes.msg import ErrorCode, GenerateSceneAction, GenerateSceneGoal, Scene, SceneRequest  # noqa: E402
from bin_scenes.srv import AddParts, GenerateScene, GetGrasps, PickPart  # noqa: E402

SMALL = """
seed: 7
bin: {inner_size: [0.16, 0.14, 0.08]}
parts:
  - {model: bracket_l.stl, unit: mm, count: 3, density: 7850}
  - {model: gear_spur.stl, unit: mm, count: 2, density: 7850}
solver: {type: bullet}
"""
CAMERA = SMALL + "sensors: [{name: camera, width: 120, height: 100}]\n"
# Takes minutes: a test that ends has cancelled it.
ENDLESS = ("{bin: {inner_size: [0.4, 0.3, 0.6]}, parts: [{model: conrod.stl, unit: mm, count: 1000}], "
           "solver: {type: bullet}}")


class Doors:
    """Services and action of a node, in a namespace."""

    def __init__(self, space=""):
        self.space = space
        rospy.wait_for_service(space + "generate_scene", 60)
        self.generate = rospy.ServiceProxy(space + "generate_scene", GenerateScene)
        self.pick = rospy.ServiceProxy(space + "pick_part", PickPart)
        self.grasps = rospy.ServiceProxy(space + "get_grasps", GetGrasps)
        self.add = rospy.ServiceProxy(space + "add_parts", AddParts)
        self.clear = rospy.ServiceProxy(space + "clear_scene", std_srvs.srv.Trigger)
        self.next = rospy.ServiceProxy(space + "next_scene", std_srvs.srv.Trigger)
        self.cancel = rospy.ServiceProxy(space + "cancel", std_srvs.srv.Trigger)

    def scene(self, yaml=SMALL, **fields):
        response = self.generate(SceneRequest(yaml=yaml, **fields))
        if (response.success, response.error_code.value, response.message) != (True, ErrorCode.NONE, ""):
            raise AssertionError(response.message)
        return response.scene

    def latched(self, seconds=10):
        return rospy.wait_for_message(self.space + "scene", Scene, seconds)


class Client:
    """An action client that keeps what it is told."""

    def __init__(self, space=""):
        self.client = actionlib.ActionClient(space + "generate", GenerateSceneAction)
        if not self.client.wait_for_server(rospy.Duration(30)):
            raise AssertionError("no action server")

    def send(self, yaml=SMALL, **fields):
        return Goal(self.client, SceneRequest(yaml=yaml, **fields))


class Goal:
    def __init__(self, client, request):
        self.feedback = []
        self.done = threading.Event()
        self.heard = threading.Condition()
        self.handle = client.send_goal(GenerateSceneGoal(request=request), self.on_transition, self.on_feedback)

    def on_transition(self, handle):
        if handle.get_comm_state() == actionlib.CommState.DONE:
            self.done.set()

    def on_feedback(self, _, feedback):
        with self.heard:
            self.feedback.append(feedback)
            self.heard.notify_all()

    def cancel(self):
        """A client that cancels before it has heard of its goal takes it for lost as soon as it gets an older status."""
        wait_until(lambda: self.handle.get_comm_state() != actionlib.CommState.WAITING_FOR_GOAL_ACK)
        self.handle.cancel()

    def wait_for_phase(self, phases, seconds=30):
        end = time.time() + seconds
        with self.heard:
            while not any(f.phase in phases for f in self.feedback):
                if time.time() > end or self.done.is_set():
                    raise AssertionError("never in %s: %s" % (phases, {f.phase for f in self.feedback}))
                self.heard.wait(0.1)

    def result(self, seconds=60):
        """(state, result)"""
        if not self.done.wait(seconds):
            raise AssertionError("no result")
        return self.handle.get_terminal_state(), self.handle.get_result()


def wait_until(condition, seconds=20, why="waited too long"):
    end = time.time() + seconds
    while not condition():
        if time.time() > end:
            raise AssertionError(why)
        time.sleep(0.02)


def run(*command, **options):
    return subprocess.run(command, capture_output=True, text=True, timeout=60, **options)


class NodeTestCase(unittest.TestCase):
    def same_pose(self, a, b):
        self.assertEqual((a.position, a.orientation), (b.position, b.orientation))
