"""What the tests of the node need to look into: meshes, clouds, transforms."""

import os

import numpy as np


def read_stl(path):
    """Triangles of a binary STL, (n, 3, 3)."""
    data = open(path, "rb").read()
    count = int(np.frombuffer(data, "<u4", 1, 80)[0])
    record = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])
    return np.frombuffer(data, record, count, 84)["vertices"].astype(float)


def model(name, models=os.environ.get("BIN_SCENES_MODELS")):
    """Triangles of a sample part in metres."""
    return 1e-3 * read_stl(os.path.join(models, name))


def matrix(position, orientation):
    """4x4 transform of a geometry_msgs position or translation and quaternion."""
    x, y, z, w = orientation.x, orientation.y, orientation.z, orientation.w
    m = np.eye(4)
    m[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    m[:3, 3] = [position.x, position.y, position.z]
    return m


def moved(transform, points):
    return points @ transform[:3, :3].T + transform[:3, 3]


def cloud_array(cloud):
    """Structured array (height, width) of a PointCloud2."""
    types = {7: "<f4", 6: "<u4"}
    layout = np.dtype({
        "names": [f.name for f in cloud.fields],
        "formats": [types[f.datatype] for f in cloud.fields],
        "offsets": [f.offset for f in cloud.fields],
        "itemsize": cloud.point_step,
    })
    return np.frombuffer(cloud.data, layout).reshape(cloud.height, cloud.width)


def image_array(image):
    return np.frombuffer(image.data, {"32FC1": "<f4", "16UC1": "<u2", "mono8": "u1"}[image.encoding]).reshape(image.height, image.width)


def xyz(points):
    return np.stack([points["x"], points["y"], points["z"]], axis=-1).astype(float)


def nearest_on_mesh(points, triangles):
    """Nearest surface point and its triangle's normal, (n, 3) each (Ericson 2005, Real-Time Collision Detection, 5.1.5)."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    ab, ac, bc = b - a, c - a, c - b
    normals = np.cross(ab, ac)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)

    def on_segment(p, start, edge):
        t = np.einsum("tk,tk->t", p - start, edge) / np.maximum(np.einsum("tk,tk->t", edge, edge), 1e-30)
        return start + np.clip(t, 0, 1)[:, None] * edge

    nearest, normal = np.empty_like(points), np.empty_like(points)
    for i, p in enumerate(points):
        foot = p - np.einsum("tk,tk->t", p - a, normals)[:, None] * normals
        inside = np.ones(len(triangles), bool)
        for start, edge in ((a, ab), (b, bc), (c, -ac)):
            inside &= np.einsum("tk,tk->t", np.cross(edge, foot - start), normals) >= 0
        candidates = [np.where(inside[:, None], foot, np.inf)]
        candidates += [on_segment(p, start, edge) for start, edge in ((a, ab), (b, bc), (c, -ac))]
        distances = np.stack([np.einsum("tk,tk->t", q - p, q - p) for q in candidates])
        which, triangle = np.unravel_index(np.argmin(distances), distances.shape)
        nearest[i], normal[i] = candidates[which][triangle], normals[triangle]
    return nearest, normal


def icp(points, triangles, transform, rounds=5):
    """Point-to-plane ICP of a mesh to points (Chen and Medioni 1992), from `transform` (mesh frame to points' frame)."""
    transform = transform.copy()
    for _ in range(rounds):
        inverse = np.linalg.inv(transform)
        local = moved(inverse, points)
        foot, normal = nearest_on_mesh(local, triangles)
        jacobian = np.hstack([np.cross(local, normal), normal])
        # What the visible surface does not hold (turning a washer about its axis) stays as it is.
        step = np.linalg.lstsq(jacobian, np.einsum("nk,nk->n", local - foot, normal), rcond=1e-6)[0]
        angle = np.linalg.norm(step[:3])
        update = np.eye(4)
        if angle > 0:
            k = np.cross(np.eye(3), step[:3] / angle)
            update[:3, :3] = np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
        update[:3, 3] = step[3:]
        transform = transform @ update
    return transform
