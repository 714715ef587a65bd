"""Poses: where a frame B stands in a frame A. The point p of B is `translation + R(rotation) p` in A."""

from __future__ import annotations

from typing import Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .v1 import geometry_pb2 as geometry

Vector = Union[Sequence[float], NDArray[np.floating], ArrayLike]


def vec3(name: str, values: Vector) -> geometry.Vec3:
    """Three numbers as a message; `name` stands in the error."""
    array = np.asarray(values, dtype=float)
    if array.shape != (3,):
        raise ValueError(f"{name}: needs 3 numbers, has shape {array.shape}")
    return geometry.Vec3(x=array[0], y=array[1], z=array[2])


def pose(translation: Vector = (0.0, 0.0, 0.0), rotation: Vector = (1.0, 0.0, 0.0, 0.0)) -> geometry.Pose:
    """From a translation in metres and a quaternion `w, x, y, z` of any norm but zero."""
    q = np.asarray(rotation, dtype=float)
    if q.shape != (4,):
        raise ValueError(f"rotation: needs the 4 numbers w, x, y, z, has shape {q.shape}")
    return geometry.Pose(
        translation=vec3("translation", translation),
        rotation=geometry.Quaternion(w=q[0], x=q[1], y=q[2], z=q[3]),
    )


def pose_from_matrix(matrix: ArrayLike) -> geometry.Pose:
    """From a homogeneous 4x4 matrix (or its upper 3x4) whose left part is a rotation."""
    m = np.asarray(matrix, dtype=float)
    if m.shape not in ((4, 4), (3, 4)):
        raise ValueError(f"matrix: needs shape (4, 4) or (3, 4), has {m.shape}")
    r = m[:3, :3]
    if not np.allclose(r @ r.T, np.eye(3), atol=1e-6) or np.linalg.det(r) < 0:
        raise ValueError("matrix: its left 3x3 part is not a rotation")
    # Four times the squares of w, x, y, z; the largest is at least 1, so the division below is safe.
    squares = 1.0 + np.array(
        [
            r[0, 0] + r[1, 1] + r[2, 2],
            r[0, 0] - r[1, 1] - r[2, 2],
            r[1, 1] - r[0, 0] - r[2, 2],
            r[2, 2] - r[0, 0] - r[1, 1],
        ]
    )
    largest = int(np.argmax(squares))
    wx, wy, wz = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    xy, yz, zx = r[0, 1] + r[1, 0], r[1, 2] + r[2, 1], r[2, 0] + r[0, 2]
    # Row i holds q_i times the whole quaternion, times four.
    products = np.array(
        [
            [squares[0], wx, wy, wz],
            [wx, squares[1], xy, zx],
            [wy, xy, squares[2], yz],
            [wz, zx, yz, squares[3]],
        ]
    )[largest]
    return pose(m[:3, 3], products / np.linalg.norm(products))


def random_pose(generator: np.random.Generator, reach: float = 1.0) -> geometry.Pose:
    """Any rotation with equal chance, and a translation within `reach` metres along each axis."""
    return pose(generator.uniform(-reach, reach, 3), generator.normal(size=4))
