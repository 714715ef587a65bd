"""Ask a clearance daemon how far apart things are.

    client = clearance.Client("127.0.0.1:50551")
    scene = client.create_scene("cell")
    scene.apply(clearance.add_body("ball", clearance.sphere(0.5), clearance.pose([0, 0, 1])))

Metres, radians, right-handed frames. Arrays in and out are numpy's. Errors are :class:`ClearanceError`.
"""

from .answers import Applied, Bracket, Cost, ItemAnswer, PairAnswer, Side, StatesAnswer, Verdict
from .client import DEFAULT_ADDRESS, Client, Scene, changed_since
from .contacts import ContactEvent, ContactKind, ContactState, ContactStep, ContactWatch
from .edits import (
    add_body,
    add_robot,
    allow_collision,
    body,
    group,
    link,
    move_body,
    move_robot,
    remove_body,
    remove_robot,
    replace_shape,
    robot,
    set_pair_margin,
)
from .errors import (
    ClearanceError,
    Conflict,
    DeadlineExceeded,
    InvalidRequest,
    LimitExceeded,
    NotFound,
    RevisionGone,
    Unavailable,
)
from .poses import pose, pose_from_matrix, random_pose
from .robots import Joint, Robot
from .shapes import (
    ball_swept,
    box,
    capsule,
    compound,
    cone,
    convex,
    cylinder,
    ellipsoid,
    half_space,
    mesh,
    plane,
    point,
    segment,
    sphere,
    triangle,
)

__all__ = [
    "Applied",
    "Bracket",
    "ClearanceError",
    "Client",
    "DEFAULT_ADDRESS",
    "Conflict",
    "ContactEvent",
    "ContactKind",
    "ContactState",
    "ContactStep",
    "ContactWatch",
    "Cost",
    "DeadlineExceeded",
    "InvalidRequest",
    "ItemAnswer",
    "Joint",
    "LimitExceeded",
    "NotFound",
    "PairAnswer",
    "RevisionGone",
    "Robot",
    "Scene",
    "Side",
    "StatesAnswer",
    "Unavailable",
    "Verdict",
    "add_body",
    "add_robot",
    "allow_collision",
    "ball_swept",
    "body",
    "box",
    "capsule",
    "changed_since",
    "compound",
    "cone",
    "convex",
    "cylinder",
    "ellipsoid",
    "group",
    "half_space",
    "link",
    "mesh",
    "move_body",
    "move_robot",
    "plane",
    "point",
    "pose",
    "pose_from_matrix",
    "random_pose",
    "remove_body",
    "remove_robot",
    "replace_shape",
    "robot",
    "segment",
    "set_pair_margin",
    "sphere",
    "triangle",
]
