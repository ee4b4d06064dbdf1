#!/usr/bin/python3
"""pick_part, add_parts, next_scene, clear_scene: what lies in the bin changes, and the topics with it."""

import copy
import json
import math
import os
import sys
import time

import dynamic_reconfigure.client
import numpy as np
import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_data as data  # noqa: E402
from scene_client import CAMERA, Doors, NodeTestCase, wait_until  # noqa: E402
from bin_scenes.msg import ErrorCode, PartLine, ScenePart  # noqa: E402
from diagnostic_msgs.msg import DiagnosticArray  # noqa: E402
from geometry_msgs.msg import Vector3  # noqa: E402
from sensor_msgs.msg import PointCloud2  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

class HeapTest(NodeTestCase):
    @classmethod
    def setUpClass(cls):
        cls.doors = Doors()

    def picked(self, ids, **lift):
        response = self.doors.pick(ids=ids, **lift)
        self.assertEqual((response.success, response.message), (True, ""))
        return response.scene

    def test_a_heap_is_emptied_part_by_part(self):
        scene = self.doors.scene(CAMERA)
        for count, part in enumerate(list(scene.parts), 1):
            before, scene = scene, self.picked([part.id])
            self.assertGreater(scene.header.stamp, before.header.stamp)
            self.assertEqual(len(scene.parts), 5)
            gone = [p for p in scene.parts if p.state == ScenePart.REMOVED]
            self.assertEqual(len(gone), count)
            self.assertTrue(all(math.isnan(p.pose.position.x) for p in gone))
            self.assertEqual(self.doors.latched().header.stamp, scene.header.stamp)
        cloud = rospy.wait_for_message("points", PointCloud2, 20)
        self.assertEqual(cloud.header.stamp, scene.header.stamp)
        self.assertFalse(self.doors.pick(ids=[0]).success)

    def test_parts_that_a_pick_does_not_touch_keep_their_pose_bit_for_bit(self):
        before = self.doors.scene(set=["solver.type=sphere", "bin.inner_size=[0.6,0.5,0.1]"])
        far = max(before.parts, key=lambda p: math.hypot(p.pose.position.x, p.pose.position.y))
        after = self.picked([far.id])
        same = sum(a.pose == b.pose for a, b in zip(before.parts, after.parts))
        self.assertGreaterEqual(same, 3)
        self.assertEqual(after.parts[far.id].state, ScenePart.REMOVED)

    def test_a_lift_takes_parts_out_too(self):
        self.doors.scene(set=["solver.type=sphere"])
        after = self.picked([2], lift_distance=0.05)
        self.assertEqual(after.parts[2].state, ScenePart.REMOVED)
        response = self.doors.pick(ids=[1], lift_distance=1e6)
        self.assertEqual(response.error_code.value, ErrorCode.INPUT)
        self.assertIn("lift", response.message)

    def test_grasps_are_told_and_shown(self):
        from visualization_msgs.msg import MarkerArray
        scene = self.doors.scene(set=["grippers=[cup_10mm, {name: two, stroke: 0.06}]"])
        told = self.doors.grasps(best=5)
        self.assertEqual((told.success, told.message), (True, ""))
        self.assertEqual(told.poses.header, scene.header.__class__(0, scene.header.stamp, scene.header.frame_id))
        self.assertTrue(0 < len(told.poses.poses) <= 5)
        self.assertTrue(all(told.free))
        self.assertEqual(sorted(told.scores, reverse=True), list(told.scores))
        for row in (told.parts, told.grippers, told.widths, told.reasons):
            self.assertEqual(len(row), len(told.poses.poses))
        markers = rospy.wait_for_message("grasps", MarkerArray, 20).markers
        self.assertEqual(len(markers), 1 + 3 * len(told.parts))  # the old ones go, then two fingers or cup, tube; palm
        every = self.doors.grasps(ids=[told.parts[0]], all=True)
        self.assertEqual(set(every.parts), {told.parts[0]})
        self.assertTrue(all(free == (reason == "") for free, reason in zip(every.free, every.reasons)))
        self.check_fields_of_parts(every, grippers=["cup_10mm", "two"])
        self.assertEqual([json.loads(text)["name"] for text in every.gripper_descriptions], ["cup_10mm", "two"])
        self.assertEqual(len(every.tilted), len(every.part_ids))
        self.assertEqual((len(told.proved), len(told.disturbed_ids)), (0, 0))
        proved = self.doors.grasps(ids=[told.parts[0]], prove=3)
        self.assertEqual(len(proved.proved), min(3, len(proved.parts)))
        self.assertEqual(proved.proof_outcomes[0], "lifted")  # of the best grasp
        self.assertTrue(set(proved.proof_outcomes) <= {"lifted", "missed", "slipped", "jammed", "dragged"})
        self.assertEqual(proved.proved[0], 0)
        for values in (proved.proof_slips, proved.proof_turns):
            self.assertTrue(len(values) == len(proved.proved) and all(value >= 0 for value in values))
        self.assertEqual(len(proved.disturbed_by), len(proved.disturbed_dragged))
        # What it tells can be done: the part leaves, and its grasps with it.
        self.picked([told.parts[0]], lift_distance=0.1)
        refused = self.doors.grasps(ids=[told.parts[0]])
        self.assertEqual(refused.error_code.value, ErrorCode.INPUT)
        self.assertIn("there is no part %d" % told.parts[0], refused.message)
        self.doors.scene()
        self.assertIn("no grippers", self.doors.grasps().message)

    def check_fields_of_parts(self, told, grippers):
        """What grasps.json states of parts and models is in the answer."""
        ids = sorted(told.part_ids)
        self.assertEqual(sorted(told.removal_order), ids)
        self.assertEqual(len(told.blocked_ids), len(told.blocked_by))
        self.assertEqual(len(told.blocked_ids), len(told.blocked_areas))
        slight = {part for part, is_slight in zip(told.part_ids, told.slight) if is_slight}
        lifted = [part for part in ids if part not in set(told.blocked_ids) - slight]
        self.assertEqual(sorted(zip(told.searched_ids, told.searched_grippers)),
                         [(part, gripper) for part in lifted for gripper in grippers])
        for tried, free, tilt in zip(told.searched_tried, told.searched_free, told.searched_least_tilts):
            self.assertLessEqual(free, tried)
            self.assertEqual(tilt > 10.0, tried == 0)
        self.assertEqual(len(told.held_ids), len(told.held_sets))
        self.assertTrue(set(told.held_ids) <= set(told.blocked_ids))
        self.assertEqual(set(told.model_grippers), set(grippers))
        self.assertTrue(all(0.0 <= coverage < 1.0 for coverage in told.coverages))
        self.assertEqual(len(told.coverages), len(told.model_lines))

    def test_a_part_is_picked_by_a_grasp(self):
        grippers = ["grippers=[{name: two, stroke: 0.06}, cup_10mm]", "solver.type=sphere"]
        before = self.doors.scene(set=grippers)
        told = self.doors.grasps(all=True)
        best = {"ids": [told.parts[0]], "gripper": told.grippers[0], "grasp": told.poses.poses[0]}
        self.assertTrue(told.free[0])
        other = next(i for i, part in enumerate(told.parts) if part != told.parts[0])
        blocked = told.free.index(False)
        nowhere = copy.deepcopy(best["grasp"])
        nowhere.position.z += 0.003
        for change, words in (
                ({"grasp": nowhere}, "'%s' has no grasp at that pose" % told.grippers[0]),
                ({"gripper": "three"}, "no gripper 'three'"),
                ({"ids": [told.parts[other]]}, "is one of part %d, not of part %d" % (told.parts[0], told.parts[other])),
                ({"ids": [told.parts[blocked]], "gripper": told.grippers[blocked], "grasp": told.poses.poses[blocked]},
                 "the grasp is not free: " + told.reasons[blocked]),
                ({"gripper": ""}, "there is a grasp, but no gripper"),
                ({"ids": []}, "name one part"), ({"ids": [0, 1]}, "name one part"), ({"ids": [99]}, "no part 99"),
                ({"lift_direction": Vector3(1, 0, 0)}, "along the lift"), ({"lift_distance": 11}, "the distance is 11")):
            response = self.doors.pick(**dict(best, **change))
            self.assertEqual((response.success, response.error_code.value), (False, ErrorCode.INPUT), words)
            self.assertIn(words, response.message)
        self.assertEqual(self.doors.latched().header.stamp, before.header.stamp)
        after = self.doors.pick(**best).scene
        self.assertEqual([p.id for p in after.parts if p.state == ScenePart.REMOVED], best["ids"])
        stale = self.doors.pick(**best)
        self.assertIn("no part %d" % told.parts[0], stale.message)

    def test_sensors_see_the_contact_of_grasps(self):
        told = self.doors.scene(CAMERA, set=["grippers=[{name: two, stroke: 0.06}]"])
        self.assertEqual(len(self.doors.grasps().sensors), 0)
        told = self.doors.grasps(all=True, render=True)
        self.assertEqual((told.success, told.message), (True, ""))
        self.assertEqual(told.sensors, ["camera"])
        for shares in (told.visible, told.measured):
            self.assertEqual(len(shares), len(told.poses.poses))
            self.assertTrue(all(0 <= share <= 1 for share in shares))
        self.assertGreater(max(told.visible), 0.3)
        self.assertTrue(all(m <= v for m, v in zip(told.measured, told.visible)))

    def test_wrong_ids_and_distances_change_nothing(self):
        before = self.doors.scene()
        for ids in ([99], [-1], [0, 1, 2, 77]):
            response = self.doors.pick(ids=ids)
            self.assertEqual((response.success, response.error_code.value), (False, ErrorCode.INPUT))
            self.assertIn("no part", response.message)
        for distance in (float("nan"), float("inf"), -0.1, 11.0):
            response = self.doors.pick(ids=[0], lift_distance=distance)
            self.assertEqual((response.success, response.error_code.value), (False, ErrorCode.INPUT), distance)
            self.assertIn("distance", response.message)
        self.assertEqual(self.doors.latched().header.stamp, before.header.stamp)
        self.assertTrue(all(p.state == ScenePart.RESTING for p in self.picked([]).parts))

    def test_parts_are_added(self):
        before = self.doors.scene()
        response = self.doors.add(parts=[PartLine(model="nut_hex.stl", unit="mm", count=2)])
        self.assertEqual((response.success, response.message), (True, ""))
        self.assertEqual([p.id for p in response.scene.parts], list(range(7)))
        self.assertEqual({p.model for p in response.scene.parts[5:]}, {"nut_hex.stl"})
        self.assertGreater(response.scene.header.stamp, before.header.stamp)
        self.assertEqual(self.picked([6]).parts[6].state, ScenePart.REMOVED)
        for line, text in ((PartLine(model="nowhere.stl"), "nowhere.stl"), (PartLine(), "model"),
                           (PartLine(model="nut_hex.stl", unit="mm", count=10 ** 9), "count")):
            response = self.doors.add(parts=[line])
            self.assertEqual((response.success, response.error_code.value), (False, ErrorCode.INPUT))
            self.assertIn(text, response.message)
        self.assertFalse(self.doors.add(parts=[]).success)

    def test_a_cleared_bin_takes_parts_again(self):
        self.doors.scene()
        self.assertTrue(self.doors.clear().success)
        self.assertEqual(self.doors.pick(ids=[0]).error_code.value, ErrorCode.INPUT)
        response = self.doors.add(parts=[PartLine(model="nut_hex.stl", unit="mm", count=3)])
        self.assertEqual((response.success, response.message), (True, ""))
        self.assertEqual([p.id for p in response.scene.parts], [0, 1, 2])

    def test_the_next_scene_is_that_of_the_next_index(self):
        for doors in (self.doors, Doors("/ahead/")):
            first = doors.scene()
            hashes = []
            for index in (1, 2, 3):
                self.assertTrue(doors.next().success)
                scene = doors.latched()
                self.assertEqual(scene.index, first.index + index)
                hashes.append(scene.report.state_hash)
            self.assertEqual(len(set(hashes)), 3)
            asked = doors.scene(index=[2])
            self.assertEqual(asked.report.state_hash, hashes[1])
            self.assertEqual(doors.pick(ids=[1]).scene.parts[1].state, ScenePart.REMOVED)
            # What lies in the bin changes nothing about what comes next: neither parts that were added, nor none at all.
            nuts = PartLine(model="nut_hex.stl", unit="mm", count=4)
            self.assertEqual(len(doors.add(parts=[nuts]).scene.parts), 9)
            self.assertTrue(doors.next().success)
            scene = doors.latched()
            self.assertEqual((scene.index, len(scene.parts), scene.report.state_hash), (3, 5, hashes[2]))
            self.assertTrue(doors.clear().success)
            self.assertTrue(doors.next().success, "after clear_scene")
            self.assertEqual((doors.latched().index, len(doors.latched().parts)), (4, 5))
            self.assertTrue(doors.clear().success)
            self.assertEqual(len(doors.add(parts=[nuts]).scene.parts), 4)
            self.assertTrue(doors.next().success)
            self.assertEqual((doors.latched().index, len(doors.latched().parts)), (5, 5))

    def test_images_of_scenes_to_come_are_made_ahead_too(self):
        ahead, said = Doors("/ahead/"), {}
        diagnostics = rospy.Subscriber("/diagnostics", DiagnosticArray, lambda array: said.update(
            (s.name, {v.key: v.value for v in s.values}) for s in array.status))
        clouds = []
        looking = rospy.Subscriber("/ahead/points", PointCloud2, clouds.append)
        wait_until(lambda: looking.get_num_connections() > 0)  # before scenes are made ahead
        scene = ahead.scene(CAMERA)
        wait_until(lambda: clouds and clouds[-1].header.stamp == scene.header.stamp)
        wait_until(lambda: said.get("ahead/bin_scenes: scene", {}).get("scenes ahead") == "2")
        looking.unregister()
        time.sleep(1.0)  # the node sees that nobody looks any more
        self.assertTrue(ahead.next().success)
        self.assertEqual({c.name: c.value for c in ahead.latched().report.counters}["views"], 1)
        diagnostics.unregister()

    def test_scenes_made_ahead_with_noise_are_no_answer_to_a_request_without(self):
        ahead, clouds = Doors("/ahead/"), []
        config = dynamic_reconfigure.client.Client("/ahead/bin_scenes", timeout=30)
        looking = rospy.Subscriber("/ahead/points", PointCloud2, clouds.append)
        noisy = CAMERA.replace("name: camera", "name: camera, model: time_of_flight, bounces: 0")

        def roughness():
            """m, median: a pixel's depth beside the mean of its neighbours in the row."""
            wait_until(lambda: clouds and clouds[-1].header.stamp == ahead.latched().header.stamp)
            z = data.cloud_array(clouds[-1])["z"]
            return np.nanmedian(np.abs(z[:, 1:-1] - 0.5 * (z[:, 2:] + z[:, :-2])))

        try:
            with_noise = ahead.scene(noisy)
            self.assertGreater(roughness(), 3e-4)
            time.sleep(2.0)  # scenes are made ahead
            config.update_configuration({"noise": False})
            without = ahead.scene(noisy)
            self.assertLess(roughness(), 1e-4)
            self.assertNotEqual(without.request_sha256, with_noise.request_sha256)
            self.assertTrue(ahead.next().success)
            self.assertLess(roughness(), 1e-4)
        finally:
            config.update_configuration({"noise": True})
            looking.unregister()

    def test_two_bins_of_one_node_know_nothing_of_each_other(self):
        left, right = Doors("/two/left/"), Doors("/two/right/")
        one, two = left.scene(seed=[1]), right.scene(seed=[2])
        self.assertEqual(left.latched().header.stamp, one.header.stamp)
        self.assertEqual((one.parts[0].frame_id, two.parts[0].frame_id), ("left/part_0000", "right/part_0000"))
        self.assertEqual(one.header.frame_id, "left/bin")
        for _ in range(5):  # also for whoever comes late
            frames = set()
            late = rospy.Subscriber("/tf_static", TFMessage, lambda m: frames.update(t.child_frame_id for t in m.transforms))
            wait_until(lambda: {"left/bin", "right/bin"} <= frames)
            late.unregister()
        self.assertTrue(left.clear().success)
        self.assertEqual(len(right.latched().parts), 5)

    def test_everything_is_published_again_at_a_rate(self):
        streaming = Doors("/streaming/")
        first = streaming.scene(CAMERA)
        clouds = []
        subscriber = rospy.Subscriber("/streaming/points", PointCloud2, clouds.append)
        wait_until(lambda: len({c.header.stamp for c in clouds}) > 3)
        subscriber.unregister()
        self.assertGreater(clouds[-1].header.stamp, first.header.stamp)
        self.assertEqual(clouds[-1].data, clouds[0].data)
        self.assertGreater(streaming.latched().header.stamp, first.header.stamp)
        # Grasps have a stamp that is on TF, not that of ten seconds ago or more.
        first = streaming.scene(CAMERA + "grippers: [cup_10mm]\n")
        wait_until(lambda: streaming.latched().header.stamp > first.header.stamp)
        self.assertGreater(streaming.grasps().poses.header.stamp, first.header.stamp)


if __name__ == "__main__":
    rospy.init_node("heap_test", anonymous=True)
    rostest.rosrun("bin_scenes", "heap", HeapTest)
