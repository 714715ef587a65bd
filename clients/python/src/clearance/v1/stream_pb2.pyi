from clearance.v1 import geometry_pb2 as _geometry_pb2
from clearance.v1 import scene_pb2 as _scene_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class WatchRequest(_message.Message):
    __slots__ = ("scene", "epoch", "from_revision", "shapes")
    SCENE_FIELD_NUMBER: _ClassVar[int]
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    FROM_REVISION_FIELD_NUMBER: _ClassVar[int]
    SHAPES_FIELD_NUMBER: _ClassVar[int]
    scene: str
    epoch: int
    from_revision: int
    shapes: bool
    def __init__(self, scene: _Optional[str] = ..., epoch: _Optional[int] = ..., from_revision: _Optional[int] = ..., shapes: bool = ...) -> None: ...

class WatchResponse(_message.Message):
    __slots__ = ("epoch", "from_revision", "revision", "compacted", "oldest_revision", "removed_robots", "removed_bodies", "bodies", "moved", "robots", "entries", "more")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    FROM_REVISION_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    COMPACTED_FIELD_NUMBER: _ClassVar[int]
    OLDEST_REVISION_FIELD_NUMBER: _ClassVar[int]
    REMOVED_ROBOTS_FIELD_NUMBER: _ClassVar[int]
    REMOVED_BODIES_FIELD_NUMBER: _ClassVar[int]
    BODIES_FIELD_NUMBER: _ClassVar[int]
    MOVED_FIELD_NUMBER: _ClassVar[int]
    ROBOTS_FIELD_NUMBER: _ClassVar[int]
    ENTRIES_FIELD_NUMBER: _ClassVar[int]
    MORE_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    from_revision: int
    revision: int
    compacted: bool
    oldest_revision: int
    removed_robots: _containers.RepeatedScalarFieldContainer[str]
    removed_bodies: _containers.RepeatedScalarFieldContainer[int]
    bodies: _containers.RepeatedCompositeFieldContainer[WatchedBody]
    moved: _containers.RepeatedCompositeFieldContainer[MovedBody]
    robots: _containers.RepeatedCompositeFieldContainer[_scene_pb2.RobotInScene]
    entries: _containers.RepeatedCompositeFieldContainer[PairEntry]
    more: bool
    def __init__(self, epoch: _Optional[int] = ..., from_revision: _Optional[int] = ..., revision: _Optional[int] = ..., compacted: bool = ..., oldest_revision: _Optional[int] = ..., removed_robots: _Optional[_Iterable[str]] = ..., removed_bodies: _Optional[_Iterable[int]] = ..., bodies: _Optional[_Iterable[_Union[WatchedBody, _Mapping]]] = ..., moved: _Optional[_Iterable[_Union[MovedBody, _Mapping]]] = ..., robots: _Optional[_Iterable[_Union[_scene_pb2.RobotInScene, _Mapping]]] = ..., entries: _Optional[_Iterable[_Union[PairEntry, _Mapping]]] = ..., more: bool = ...) -> None: ...

class WatchedBody(_message.Message):
    __slots__ = ("body", "shape")
    BODY_FIELD_NUMBER: _ClassVar[int]
    SHAPE_FIELD_NUMBER: _ClassVar[int]
    body: _scene_pb2.Body
    shape: _geometry_pb2.Shape
    def __init__(self, body: _Optional[_Union[_scene_pb2.Body, _Mapping]] = ..., shape: _Optional[_Union[_geometry_pb2.Shape, _Mapping]] = ...) -> None: ...

class MovedBody(_message.Message):
    __slots__ = ("id", "pose", "bounds")
    ID_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    BOUNDS_FIELD_NUMBER: _ClassVar[int]
    id: int
    pose: _geometry_pb2.Pose
    bounds: _geometry_pb2.Aabb
    def __init__(self, id: _Optional[int] = ..., pose: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ..., bounds: _Optional[_Union[_geometry_pb2.Aabb, _Mapping]] = ...) -> None: ...

class PairEntry(_message.Message):
    __slots__ = ("a", "b", "allowed", "margin", "effects")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    ALLOWED_FIELD_NUMBER: _ClassVar[int]
    MARGIN_FIELD_NUMBER: _ClassVar[int]
    EFFECTS_FIELD_NUMBER: _ClassVar[int]
    a: _scene_pb2.Party
    b: _scene_pb2.Party
    allowed: bool
    margin: float
    effects: _scene_pb2.Effects
    def __init__(self, a: _Optional[_Union[_scene_pb2.Party, _Mapping]] = ..., b: _Optional[_Union[_scene_pb2.Party, _Mapping]] = ..., allowed: bool = ..., margin: _Optional[float] = ..., effects: _Optional[_Union[_scene_pb2.Effects, _Mapping]] = ...) -> None: ...

class PoseStreamRequest(_message.Message):
    __slots__ = ("scene", "epoch", "interval", "bodies", "robots")
    SCENE_FIELD_NUMBER: _ClassVar[int]
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    INTERVAL_FIELD_NUMBER: _ClassVar[int]
    BODIES_FIELD_NUMBER: _ClassVar[int]
    ROBOTS_FIELD_NUMBER: _ClassVar[int]
    scene: str
    epoch: int
    interval: float
    bodies: _containers.RepeatedCompositeFieldContainer[BodyPose]
    robots: _containers.RepeatedCompositeFieldContainer[RobotPose]
    def __init__(self, scene: _Optional[str] = ..., epoch: _Optional[int] = ..., interval: _Optional[float] = ..., bodies: _Optional[_Iterable[_Union[BodyPose, _Mapping]]] = ..., robots: _Optional[_Iterable[_Union[RobotPose, _Mapping]]] = ...) -> None: ...

class BodyPose(_message.Message):
    __slots__ = ("body", "pose")
    BODY_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    body: _scene_pb2.BodyRef
    pose: _geometry_pb2.Pose
    def __init__(self, body: _Optional[_Union[_scene_pb2.BodyRef, _Mapping]] = ..., pose: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ...) -> None: ...

class RobotPose(_message.Message):
    __slots__ = ("robot", "base")
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    BASE_FIELD_NUMBER: _ClassVar[int]
    robot: str
    base: _geometry_pb2.Pose
    def __init__(self, robot: _Optional[str] = ..., base: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ...) -> None: ...

class PoseStreamResponse(_message.Message):
    __slots__ = ("epoch", "revision", "messages", "poses", "overtaken", "refused")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    MESSAGES_FIELD_NUMBER: _ClassVar[int]
    POSES_FIELD_NUMBER: _ClassVar[int]
    OVERTAKEN_FIELD_NUMBER: _ClassVar[int]
    REFUSED_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    revision: int
    messages: int
    poses: int
    overtaken: int
    refused: _containers.RepeatedCompositeFieldContainer[RefusedPose]
    def __init__(self, epoch: _Optional[int] = ..., revision: _Optional[int] = ..., messages: _Optional[int] = ..., poses: _Optional[int] = ..., overtaken: _Optional[int] = ..., refused: _Optional[_Iterable[_Union[RefusedPose, _Mapping]]] = ...) -> None: ...

class RefusedPose(_message.Message):
    __slots__ = ("message", "field", "problem")
    MESSAGE_FIELD_NUMBER: _ClassVar[int]
    FIELD_FIELD_NUMBER: _ClassVar[int]
    PROBLEM_FIELD_NUMBER: _ClassVar[int]
    message: int
    field: str
    problem: str
    def __init__(self, message: _Optional[int] = ..., field: _Optional[str] = ..., problem: _Optional[str] = ...) -> None: ...
