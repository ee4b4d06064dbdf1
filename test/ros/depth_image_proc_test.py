#!/usr/bin/python3
"""Depth images and camera models of the live node, given to depth_image_proc as they are, make the node's own cloud."""

import os
import sys
import time
import unittest

import numpy as np
import rospy
import rostest
from sensor_msgs.msg import CameraInfo, PointCloud2

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_data as data  # noqa: E402
from bin_scenes.msg import SceneRequest  # noqa: E402
from bin_scenes.srv import GenerateScene  # noqa: E402

REQUEST = """
seed: 7
bin: {inner_size: [0.16, 0.14, 0.08], wall_thickness: 0.005}
parts: [{model: bracket_l.stl, unit: mm, count: 3, density: 7850}]
solver: {type: bullet}
sensors: [{name: camera, width: 240, height: 200, %s}]
"""
HALF_INNER, WALL = np.array([0.08, 0.07]), 0.005  # m


class DepthImageProc(unittest.TestCase):
    def clouds(self, keys):
        """Our cloud, the one made from our depth image, and the camera model, all of one new scene."""
        seen = {}
        topics = {"points": PointCloud2, "from_depth/points": PointCloud2, "depth/camera_info": CameraInfo}
        subscribers = [rospy.Subscriber(name, kind, lambda m, name=name: seen.__setitem__(name, m))
                       for name, kind in topics.items()]
        rospy.wait_for_service("generate_scene", 30)
        answer = rospy.ServiceProxy("generate_scene", GenerateScene)(request=SceneRequest(yaml=REQUEST % keys))
        self.assertTrue(answer.success, answer.message)
        stamp, end = answer.scene.header.stamp, time.time() + 30
        while time.time() < end and not (len(seen) == 3 and all(m.header.stamp == stamp for m in seen.values())):
            time.sleep(0.02)
        for subscriber in subscribers:
            subscriber.unregister()
        self.assertEqual({name: m.header.stamp for name, m in seen.items()}, dict.fromkeys(topics, stamp))
        self.assertEqual(seen["from_depth/points"].header.frame_id, seen["points"].header.frame_id)
        return (data.xyz(data.cloud_array(seen["points"])), data.xyz(data.cloud_array(seen["from_depth/points"])),
                seen["depth/camera_info"])

    def test_a_pinhole_gives_the_same_cloud(self):
        for keys in ["fov: 0.9", "model: structured_light, fov: 0.9"]:
            ours, made, _ = self.clouds(keys)
            np.testing.assert_array_equal(np.isnan(ours), np.isnan(made))
            valid = ~np.isnan(ours[:, :, 2])
            self.assertGreater(valid.mean(), 0.3)  # the bin is all there is to see
            # Both multiply a depth by a slope in single precision.
            self.assertLess(np.abs(ours - made)[valid].max(), 1e-6 * np.nanmax(ours[:, :, 2]))

    def test_of_a_distorted_lens_the_rectified_image_puts_the_walls_where_they_are(self):
        distortion = [-0.25, 0.1, 0.0, 0.0, 0.0]
        _, made, info = self.clouds("fov: 0.9, distortion: %s" % distortion)
        self.assertEqual(list(info.D), distortion)
        points = made[~np.isnan(made[:, :, 2])]
        top = points[points[:, 2] < points[:, 2].min() + 1e-3]  # the walls' upper faces are nearest
        self.assertGreater(len(top), 500)
        outside = (np.abs(top[:, :2]) - HALF_INNER).max(axis=1)  # m beyond the inner faces
        pixel = top[:, 2].max() / info.P[0]
        self.assertGreater(outside.min(), -pixel)
        self.assertLess(outside.max(), WALL + pixel)


if __name__ == "__main__":
    rospy.init_node("depth_image_proc_test")
    rostest.rosrun("bin_scenes", "depth_image_proc", DepthImageProc, sys.argv)
