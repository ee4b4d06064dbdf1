"""The live node as a test of it asks for scenes and hears their topics, and what the topics of one scene have to say
alike."""

import math
import os
import time
import unittest

import numpy as np
import rospy
import std_srvs.srv
import tf2_ros
from sensor_msgs.msg import CameraInfo, Image, PointCloud2
from visualization_msgs.msg import Marker, MarkerArray

import scene_data as data
from scene_client import SMALL
from bin_scenes.msg import ErrorCode, Scene, SceneRequest
from bin_scenes.srv import GenerateScene

REQUEST = SMALL + "sensors: [{name: camera, width: 240, height: 200}]\n"
MODELS = ["bracket_l.stl", "gear_spur.stl"]
TOPICS = {
    "scene": Scene, "markers": MarkerArray, "points": PointCloud2, "depth/image_rect": Image,
    "depth/camera_info": CameraInfo, "labels/image_raw": Image, "validity/image_raw": Image,
}
TOLERANCE = 0.3e-3  # m: points on their part's mesh


class Listener:
    """The last message of every topic of the node."""

    def __init__(self, topics=TOPICS):
        self.seen = {}
        self.subscribers = [rospy.Subscriber(name, kind, self.remember(name))
                            for name, kind in topics.items()]

    def remember(self, name):
        return lambda message: self.seen.__setitem__(name, message)

    def wait(self, stamp, names=TOPICS, seconds=20):
        """Messages with that stamp."""
        end = time.time() + seconds
        while time.time() < end:
            if all(n in self.seen and self.stamp(self.seen[n]) == stamp for n in names):
                return {n: self.seen[n] for n in names}
            time.sleep(0.02)
        raise AssertionError("not all topics have stamp %s: %s" % (
            stamp, {n: str(self.stamp(m)) for n, m in self.seen.items()}))

    @staticmethod
    def stamp(message):
        return message.markers[0].header.stamp if hasattr(message, "markers") else message.header.stamp

    def close(self):
        for subscriber in self.subscribers:
            subscriber.unregister()


def counter(scene, name):
    return {c.name: c.value for c in scene.report.counters}.get(name, 0)


class NodeCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("generate_scene", 60)
        cls.service = rospy.ServiceProxy("generate_scene", GenerateScene)
        cls.clear = rospy.ServiceProxy("clear_scene", std_srvs.srv.Trigger)
        cls.tf = tf2_ros.Buffer(rospy.Duration(60))
        cls.tf_listener = tf2_ros.TransformListener(cls.tf)

    def generate(self, **fields):
        fields.setdefault("yaml", REQUEST)
        return self.service(SceneRequest(**fields))

    def scene(self, **fields):
        response = self.generate(**fields)
        self.assertEqual((response.success, response.error_code.value, response.message), (True, ErrorCode.NONE, ""))
        return response.scene

    def scene_on_topics(self, **fields):
        listener = Listener()
        try:
            time.sleep(0.3)  # let the node see its subscribers, so that it renders at once
            scene = self.scene(**fields)
            return scene, listener.wait(scene.header.stamp)
        finally:
            listener.close()

    def lookup(self, frame, stamp, parent="bin"):
        t = self.tf.lookup_transform(parent, frame, stamp, rospy.Duration(5)).transform
        return data.matrix(t.translation, t.rotation)

    def wait_until(self, condition, seconds=20):
        end = time.time() + seconds
        while not condition():
            self.assertLess(time.time(), end, "waited too long")
            time.sleep(0.05)

    def check_frames(self, scene, cloud):
        for part in scene.parts:
            truth = data.matrix(part.pose.position, part.pose.orientation)
            np.testing.assert_allclose(self.lookup("part_%04d" % part.id, scene.header.stamp), truth, atol=1e-12)
            self.assertEqual(part.frame_id, "part_%04d" % part.id)
        camera = data.matrix(scene.sensors[0].pose.position, scene.sensors[0].pose.orientation)
        np.testing.assert_allclose(self.lookup(cloud.header.frame_id, scene.header.stamp), camera, atol=1e-12)
        np.testing.assert_allclose(self.lookup("bin", scene.header.stamp, "world"), np.eye(4), atol=1e-12)

    def check_images(self, scene, topics):
        cloud, info = topics["points"], topics["depth/camera_info"]
        for name in ("points", "depth/image_rect", "depth/camera_info", "labels/image_raw"):
            self.assertEqual(topics[name].header.frame_id, "camera_optical_frame", name)
            self.assertEqual((topics[name].width, topics[name].height), (240, 200), name)
        self.assertEqual([f.name for f in cloud.fields],
                         ["x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity", "snr", "label"])
        self.assertFalse(cloud.is_dense)
        self.assertEqual(cloud.row_step, cloud.width * cloud.point_step)
        points = data.cloud_array(cloud)
        depth = data.image_array(topics["depth/image_rect"])
        labels = data.image_array(topics["labels/image_raw"])
        np.testing.assert_array_equal(points["z"], depth)
        np.testing.assert_array_equal(points["label"], labels)
        valid = np.isfinite(depth)
        self.assertGreater(valid.mean(), 0.3)
        self.assertTrue(np.isnan(points["x"][~valid]).all() and (labels[~valid] == 0).all())
        self.assertLessEqual(set(np.unique(labels)), {0} | {p.id + 1 for p in scene.parts})
        k = np.array(info.K).reshape(3, 3)
        rows, columns = np.nonzero(valid)
        pixels = (data.xyz(points[valid]) @ k.T) / depth[valid][:, None].astype(float)
        np.testing.assert_allclose(pixels[:, 0], columns, atol=1e-3)
        np.testing.assert_allclose(pixels[:, 1], rows, atol=1e-3)
        np.testing.assert_array_equal(np.array(info.P).reshape(3, 4)[:, :3], k)
        normals = np.stack([points["normal_x"], points["normal_y"], points["normal_z"]], -1)[valid].astype(float)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-4)
        self.assertTrue((np.einsum("nk,nk->n", normals, data.xyz(points[valid])) < 1e-6).all(), "towards the camera")

    def check_points_on_meshes(self, scene, topics):
        """Through TF alone: cloud -> camera frame -> bin -> part."""
        cloud = topics["points"]
        stamp, points = cloud.header.stamp, data.cloud_array(cloud)
        random = np.random.RandomState(1)
        looked_at = 0
        for part in scene.parts:
            of_part = data.xyz(points[points["label"] == part.id + 1])
            self.assertEqual(len(of_part) > 0, part.visible_fraction[0] > 0.0, "part %d" % part.id)
            if len(of_part) < 50:
                continue
            looked_at += 1
            some = of_part[random.choice(len(of_part), min(len(of_part), 150), replace=False)]
            to_camera = self.lookup("part_%04d" % part.id, stamp, cloud.header.frame_id)
            mesh = data.model(MODELS[part.line])
            local = data.moved(np.linalg.inv(to_camera), some)
            foot, _ = data.nearest_on_mesh(local, mesh)
            self.assertLess(np.linalg.norm(local - foot, axis=1).max(), TOLERANCE, "part %d" % part.id)
            if part.line == 0 and part.visible_fraction[0] > 0.5:
                self.check_icp(some, mesh, to_camera)
        self.assertGreaterEqual(looked_at, 3)

    def check_icp(self, points, mesh, truth):
        """From 1 mm and 1 degree beside the truth back to it."""
        start = truth.copy()
        start[:3, 3] += [0.6e-3, -0.6e-3, 0.5e-3]
        angle = math.radians(1)
        start[:3, :3] = truth[:3, :3] @ np.array([[1, 0, 0], [0, math.cos(angle), -math.sin(angle)],
                                                  [0, math.sin(angle), math.cos(angle)]])
        found = data.icp(points, mesh, start, rounds=12)
        corners = mesh.reshape(-1, 3)
        error = np.linalg.norm(data.moved(found, corners) - data.moved(truth, corners), axis=1).max()
        self.assertLess(error, TOLERANCE)

    def check_markers(self, scene, array):
        self.assertEqual(array.markers[0].action, Marker.DELETEALL)
        parts = {m.id: m for m in array.markers if m.ns == "parts"}
        self.assertEqual(sorted(parts), [p.id for p in scene.parts])
        for part in scene.parts:
            marker = parts[part.id]
            self.assertEqual(marker.pose, part.pose)
            self.assertEqual(marker.type, Marker.MESH_RESOURCE)
            self.assertEqual(marker.scale.x, 1e-3)
            self.assertTrue(marker.mesh_resource.startswith("file:///"))
            self.assertTrue(os.path.exists(marker.mesh_resource[len("file://"):]))
        self.assertEqual(sum(m.ns == "bin" for m in array.markers), 5)
