#!/usr/bin/python3
"""The action `generate`, the queue behind it, and who is cancelled by whom."""

import os
import signal
import subprocess
import sys
import time

import rospy
import rostest
from actionlib import TerminalState

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scene_client import CAMERA, ENDLESS, SMALL, Client, Doors, NodeTestCase, wait_until  # noqa: E402
from bin_scenes.msg import ErrorCode  # noqa: E402


class ActionTest(NodeTestCase):
    @classmethod
    def setUpClass(cls):
        cls.doors = Doors()
        cls.client = Client()
        cls.preempting = Client("/preempting/")

    def assert_cancelled(self, goal, reason):
        state, result = goal.result(20)
        self.assertEqual(state, TerminalState.PREEMPTED)
        self.assertEqual((result.success, result.error_code.value), (False, ErrorCode.CANCELLED))
        self.assertIn(reason, result.message)

    def test_a_goal_ends_with_the_scene_that_the_topics_show(self):
        goal = self.client.send(CAMERA)
        state, result = goal.result()
        self.assertEqual((state, result.success, result.message), (TerminalState.SUCCEEDED, True, ""))
        self.assertEqual(len(result.scene.parts), 5)
        self.assertEqual(self.doors.latched().header.stamp, result.scene.header.stamp)
        self.assertEqual(self.doors.scene(CAMERA).report.state_hash, result.scene.report.state_hash)

    def test_feedback_tells_how_far_it_is(self):
        goal = self.client.send(ENDLESS)
        wait_until(lambda: sum(f.simulated_s > 0 for f in goal.feedback) > 10)
        goal.cancel()
        self.assert_cancelled(goal, "client")
        told = goal.feedback
        self.assertEqual([f.fraction for f in told], sorted(f.fraction for f in told))
        self.assertEqual({f.parts for f in told if f.simulated_s > 0}, {1000})
        for f in told:
            self.assertTrue(0 <= f.fraction <= 1 and (f.remaining_s == -1 or f.remaining_s >= 0), f)
            self.assertIn(f.phase, ("queued", "load", "prepare", "pour", "settle", "quality", "render"))

    def test_cancelling_leaves_the_last_whole_scene(self):
        before = self.doors.scene()
        for phases in (("queued", "load", "prepare", "pour"), ("pour",)):
            goal = self.client.send(ENDLESS)
            goal.wait_for_phase(phases)
            goal.cancel()
            self.assert_cancelled(goal, "client")
            self.assertEqual(self.doors.latched().header.stamp, before.header.stamp)
        self.doors.scene()

    def test_a_wrong_goal_is_aborted_with_its_reason(self):
        for yaml, text in (("parts: [{model: nowhere.stl}]", "nowhere.stl"), ("{{", "request"), ("solvr: {}", "solver")):
            state, result = self.client.send(yaml).result()
            self.assertEqual((state, result.error_code.value), (TerminalState.ABORTED, ErrorCode.INPUT))
            self.assertIn(text, result.message)

    def test_goals_wait_for_each_other(self):
        goals = [self.client.send(seed=[seed]) for seed in (1, 2, 3)]
        seeds = []
        for goal in goals:
            state, result = goal.result()
            self.assertEqual(state, TerminalState.SUCCEEDED)
            seeds.append(result.scene.seed)
            stamps = [g.handle.get_result().scene.header.stamp for g in goals if g.done.is_set()]
            self.assertEqual(stamps, sorted(stamps))
        self.assertEqual(seeds, [1, 2, 3])

    def test_a_newer_goal_preempts_where_that_is_wanted(self):
        first = self.preempting.send(ENDLESS)
        first.wait_for_phase(("pour",))
        second = self.preempting.send()
        self.assert_cancelled(first, "newer goal")
        self.assertEqual(second.result()[0], TerminalState.SUCCEEDED)

    def test_waiting_goals_and_too_many_of_them_end_as_well(self):
        running = self.client.send(ENDLESS)
        running.wait_for_phase(("pour",))
        waiting = [self.client.send() for _ in range(4)]
        refused = self.client.send()
        state, result = refused.result(20)
        self.assertEqual((state, result.error_code.value), (TerminalState.ABORTED, ErrorCode.ENVIRONMENT))
        self.assertIn("~queue_size", result.message)
        waiting[2].cancel()
        self.assert_cancelled(waiting[2], "client")
        message = self.doors.cancel().message
        self.assertEqual(message, "4 jobs cancelled")
        for goal in [running] + waiting[:2] + waiting[3:]:
            self.assert_cancelled(goal, "service cancel")

    def test_a_call_whose_client_is_killed_is_cancelled(self):
        before = self.doors.scene()
        caller = subprocess.Popen(["rosservice", "call", "/generate_scene", "request: {yaml: '%s'}" % ENDLESS],
                                  start_new_session=True)
        time.sleep(3.0)
        self.assertIsNone(caller.poll())
        os.killpg(caller.pid, signal.SIGKILL)
        caller.wait()
        self.assertTrue(self.doors.clear().success)  # would wait for minutes
        self.assertGreater(self.doors.latched().header.stamp, before.header.stamp)
        self.assertEqual(self.doors.latched().parts, [])

    def test_calls_and_goals_take_turns(self):
        goals = [self.client.send(seed=[seed]) for seed in (11, 12)]
        wait_until(lambda: all(goal.feedback for goal in goals))  # in the queue: they and calls come by other ways
        called = self.doors.scene(SMALL, seed=[13])
        stamps = [goal.result()[1].scene.header.stamp for goal in goals]
        self.assertEqual(sorted(stamps + [called.header.stamp]), stamps + [called.header.stamp])


if __name__ == "__main__":
    rospy.init_node("action_test", anonymous=True)
    rostest.rosrun("bin_scenes", "action", ActionTest)
