from clearance.v1 import geometry_pb2 as _geometry_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Effect(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    EFFECT_UNSPECIFIED: _ClassVar[Effect]
    EFFECT_VERDICT: _ClassVar[Effect]
    EFFECT_MARGIN: _ClassVar[Effect]
    EFFECT_DISTANCE: _ClassVar[Effect]
    EFFECT_WITNESS: _ClassVar[Effect]
    EFFECT_DEPTH: _ClassVar[Effect]
    EFFECT_PATCH: _ClassVar[Effect]
    EFFECT_MOTION: _ClassVar[Effect]
    EFFECT_DERIVATIVES: _ClassVar[Effect]
    EFFECT_EVENTS: _ClassVar[Effect]

class BroadPhase(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    BROAD_PHASE_UNSPECIFIED: _ClassVar[BroadPhase]
    BROAD_PHASE_TREE: _ClassVar[BroadPhase]
    BROAD_PHASE_SWEEP_AND_PRUNE: _ClassVar[BroadPhase]
    BROAD_PHASE_EXHAUSTIVE: _ClassVar[BroadPhase]
EFFECT_UNSPECIFIED: Effect
EFFECT_VERDICT: Effect
EFFECT_MARGIN: Effect
EFFECT_DISTANCE: Effect
EFFECT_WITNESS: Effect
EFFECT_DEPTH: Effect
EFFECT_PATCH: Effect
EFFECT_MOTION: Effect
EFFECT_DERIVATIVES: Effect
EFFECT_EVENTS: Effect
BROAD_PHASE_UNSPECIFIED: BroadPhase
BROAD_PHASE_TREE: BroadPhase
BROAD_PHASE_SWEEP_AND_PRUNE: BroadPhase
BROAD_PHASE_EXHAUSTIVE: BroadPhase

class BodyRef(_message.Message):
    __slots__ = ("id", "name")
    ID_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    id: int
    name: str
    def __init__(self, id: _Optional[int] = ..., name: _Optional[str] = ...) -> None: ...

class LinkRef(_message.Message):
    __slots__ = ("robot", "link")
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    LINK_FIELD_NUMBER: _ClassVar[int]
    robot: str
    link: str
    def __init__(self, robot: _Optional[str] = ..., link: _Optional[str] = ...) -> None: ...

class Party(_message.Message):
    __slots__ = ("body", "link", "group", "robot", "everything")
    BODY_FIELD_NUMBER: _ClassVar[int]
    LINK_FIELD_NUMBER: _ClassVar[int]
    GROUP_FIELD_NUMBER: _ClassVar[int]
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    EVERYTHING_FIELD_NUMBER: _ClassVar[int]
    body: BodyRef
    link: LinkRef
    group: str
    robot: str
    everything: Everything
    def __init__(self, body: _Optional[_Union[BodyRef, _Mapping]] = ..., link: _Optional[_Union[LinkRef, _Mapping]] = ..., group: _Optional[str] = ..., robot: _Optional[str] = ..., everything: _Optional[_Union[Everything, _Mapping]] = ...) -> None: ...

class Everything(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class Edit(_message.Message):
    __slots__ = ("add_body", "move_body", "remove_body", "replace_shape", "set_groups", "set_layers", "add_robot", "move_robot", "remove_robot", "set_allowed_collision", "set_pair_margin", "set_enabled", "insert_points", "clear_box", "declare_effects")
    ADD_BODY_FIELD_NUMBER: _ClassVar[int]
    MOVE_BODY_FIELD_NUMBER: _ClassVar[int]
    REMOVE_BODY_FIELD_NUMBER: _ClassVar[int]
    REPLACE_SHAPE_FIELD_NUMBER: _ClassVar[int]
    SET_GROUPS_FIELD_NUMBER: _ClassVar[int]
    SET_LAYERS_FIELD_NUMBER: _ClassVar[int]
    ADD_ROBOT_FIELD_NUMBER: _ClassVar[int]
    MOVE_ROBOT_FIELD_NUMBER: _ClassVar[int]
    REMOVE_ROBOT_FIELD_NUMBER: _ClassVar[int]
    SET_ALLOWED_COLLISION_FIELD_NUMBER: _ClassVar[int]
    SET_PAIR_MARGIN_FIELD_NUMBER: _ClassVar[int]
    SET_ENABLED_FIELD_NUMBER: _ClassVar[int]
    INSERT_POINTS_FIELD_NUMBER: _ClassVar[int]
    CLEAR_BOX_FIELD_NUMBER: _ClassVar[int]
    DECLARE_EFFECTS_FIELD_NUMBER: _ClassVar[int]
    add_body: AddBody
    move_body: MoveBody
    remove_body: RemoveBody
    replace_shape: ReplaceShape
    set_groups: SetGroups
    set_layers: SetLayers
    add_robot: AddRobot
    move_robot: MoveRobot
    remove_robot: RemoveRobot
    set_allowed_collision: SetAllowedCollision
    set_pair_margin: SetPairMargin
    set_enabled: SetEnabled
    insert_points: InsertPoints
    clear_box: ClearBox
    declare_effects: DeclareEffects
    def __init__(self, add_body: _Optional[_Union[AddBody, _Mapping]] = ..., move_body: _Optional[_Union[MoveBody, _Mapping]] = ..., remove_body: _Optional[_Union[RemoveBody, _Mapping]] = ..., replace_shape: _Optional[_Union[ReplaceShape, _Mapping]] = ..., set_groups: _Optional[_Union[SetGroups, _Mapping]] = ..., set_layers: _Optional[_Union[SetLayers, _Mapping]] = ..., add_robot: _Optional[_Union[AddRobot, _Mapping]] = ..., move_robot: _Optional[_Union[MoveRobot, _Mapping]] = ..., remove_robot: _Optional[_Union[RemoveRobot, _Mapping]] = ..., set_allowed_collision: _Optional[_Union[SetAllowedCollision, _Mapping]] = ..., set_pair_margin: _Optional[_Union[SetPairMargin, _Mapping]] = ..., set_enabled: _Optional[_Union[SetEnabled, _Mapping]] = ..., insert_points: _Optional[_Union[InsertPoints, _Mapping]] = ..., clear_box: _Optional[_Union[ClearBox, _Mapping]] = ..., declare_effects: _Optional[_Union[DeclareEffects, _Mapping]] = ...) -> None: ...

class AddBody(_message.Message):
    __slots__ = ("name", "shape", "pose", "groups", "layers", "mask", "padding", "scale")
    NAME_FIELD_NUMBER: _ClassVar[int]
    SHAPE_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    GROUPS_FIELD_NUMBER: _ClassVar[int]
    LAYERS_FIELD_NUMBER: _ClassVar[int]
    MASK_FIELD_NUMBER: _ClassVar[int]
    PADDING_FIELD_NUMBER: _ClassVar[int]
    SCALE_FIELD_NUMBER: _ClassVar[int]
    name: str
    shape: _geometry_pb2.Shape
    pose: _geometry_pb2.Pose
    groups: _containers.RepeatedScalarFieldContainer[str]
    layers: int
    mask: int
    padding: float
    scale: float
    def __init__(self, name: _Optional[str] = ..., shape: _Optional[_Union[_geometry_pb2.Shape, _Mapping]] = ..., pose: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ..., groups: _Optional[_Iterable[str]] = ..., layers: _Optional[int] = ..., mask: _Optional[int] = ..., padding: _Optional[float] = ..., scale: _Optional[float] = ...) -> None: ...

class MoveBody(_message.Message):
    __slots__ = ("body", "pose")
    BODY_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    body: BodyRef
    pose: _geometry_pb2.Pose
    def __init__(self, body: _Optional[_Union[BodyRef, _Mapping]] = ..., pose: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ...) -> None: ...

class InsertPoints(_message.Message):
    __slots__ = ("body", "points")
    BODY_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    body: BodyRef
    points: _geometry_pb2.Numbers
    def __init__(self, body: _Optional[_Union[BodyRef, _Mapping]] = ..., points: _Optional[_Union[_geometry_pb2.Numbers, _Mapping]] = ...) -> None: ...

class ClearBox(_message.Message):
    __slots__ = ("body", "box")
    BODY_FIELD_NUMBER: _ClassVar[int]
    BOX_FIELD_NUMBER: _ClassVar[int]
    body: BodyRef
    box: _geometry_pb2.Aabb
    def __init__(self, body: _Optional[_Union[BodyRef, _Mapping]] = ..., box: _Optional[_Union[_geometry_pb2.Aabb, _Mapping]] = ...) -> None: ...

class RemoveBody(_message.Message):
    __slots__ = ("body",)
    BODY_FIELD_NUMBER: _ClassVar[int]
    body: BodyRef
    def __init__(self, body: _Optional[_Union[BodyRef, _Mapping]] = ...) -> None: ...

class ReplaceShape(_message.Message):
    __slots__ = ("body", "shape", "padding", "scale")
    BODY_FIELD_NUMBER: _ClassVar[int]
    SHAPE_FIELD_NUMBER: _ClassVar[int]
    PADDING_FIELD_NUMBER: _ClassVar[int]
    SCALE_FIELD_NUMBER: _ClassVar[int]
    body: BodyRef
    shape: _geometry_pb2.Shape
    padding: float
    scale: float
    def __init__(self, body: _Optional[_Union[BodyRef, _Mapping]] = ..., shape: _Optional[_Union[_geometry_pb2.Shape, _Mapping]] = ..., padding: _Optional[float] = ..., scale: _Optional[float] = ...) -> None: ...

class SetGroups(_message.Message):
    __slots__ = ("body", "groups")
    BODY_FIELD_NUMBER: _ClassVar[int]
    GROUPS_FIELD_NUMBER: _ClassVar[int]
    body: BodyRef
    groups: _containers.RepeatedScalarFieldContainer[str]
    def __init__(self, body: _Optional[_Union[BodyRef, _Mapping]] = ..., groups: _Optional[_Iterable[str]] = ...) -> None: ...

class SetLayers(_message.Message):
    __slots__ = ("body", "layers", "mask")
    BODY_FIELD_NUMBER: _ClassVar[int]
    LAYERS_FIELD_NUMBER: _ClassVar[int]
    MASK_FIELD_NUMBER: _ClassVar[int]
    body: BodyRef
    layers: int
    mask: int
    def __init__(self, body: _Optional[_Union[BodyRef, _Mapping]] = ..., layers: _Optional[int] = ..., mask: _Optional[int] = ...) -> None: ...

class SetEnabled(_message.Message):
    __slots__ = ("body", "enabled")
    BODY_FIELD_NUMBER: _ClassVar[int]
    ENABLED_FIELD_NUMBER: _ClassVar[int]
    body: BodyRef
    enabled: bool
    def __init__(self, body: _Optional[_Union[BodyRef, _Mapping]] = ..., enabled: bool = ...) -> None: ...

class AddRobot(_message.Message):
    __slots__ = ("name", "model", "base")
    NAME_FIELD_NUMBER: _ClassVar[int]
    MODEL_FIELD_NUMBER: _ClassVar[int]
    BASE_FIELD_NUMBER: _ClassVar[int]
    name: str
    model: str
    base: _geometry_pb2.Pose
    def __init__(self, name: _Optional[str] = ..., model: _Optional[str] = ..., base: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ...) -> None: ...

class MoveRobot(_message.Message):
    __slots__ = ("robot", "base")
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    BASE_FIELD_NUMBER: _ClassVar[int]
    robot: str
    base: _geometry_pb2.Pose
    def __init__(self, robot: _Optional[str] = ..., base: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ...) -> None: ...

class RemoveRobot(_message.Message):
    __slots__ = ("robot",)
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    robot: str
    def __init__(self, robot: _Optional[str] = ...) -> None: ...

class SetAllowedCollision(_message.Message):
    __slots__ = ("a", "b", "allowed")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    ALLOWED_FIELD_NUMBER: _ClassVar[int]
    a: Party
    b: Party
    allowed: bool
    def __init__(self, a: _Optional[_Union[Party, _Mapping]] = ..., b: _Optional[_Union[Party, _Mapping]] = ..., allowed: bool = ...) -> None: ...

class SetPairMargin(_message.Message):
    __slots__ = ("a", "b", "margin")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    MARGIN_FIELD_NUMBER: _ClassVar[int]
    a: Party
    b: Party
    margin: float
    def __init__(self, a: _Optional[_Union[Party, _Mapping]] = ..., b: _Optional[_Union[Party, _Mapping]] = ..., margin: _Optional[float] = ...) -> None: ...

class DeclareEffects(_message.Message):
    __slots__ = ("a", "b", "effects")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    EFFECTS_FIELD_NUMBER: _ClassVar[int]
    a: Party
    b: Party
    effects: Effects
    def __init__(self, a: _Optional[_Union[Party, _Mapping]] = ..., b: _Optional[_Union[Party, _Mapping]] = ..., effects: _Optional[_Union[Effects, _Mapping]] = ...) -> None: ...

class Effects(_message.Message):
    __slots__ = ("effects",)
    EFFECTS_FIELD_NUMBER: _ClassVar[int]
    effects: _containers.RepeatedScalarFieldContainer[Effect]
    def __init__(self, effects: _Optional[_Iterable[_Union[Effect, str]]] = ...) -> None: ...

class PartyPair(_message.Message):
    __slots__ = ("a", "b")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    a: Party
    b: Party
    def __init__(self, a: _Optional[_Union[Party, _Mapping]] = ..., b: _Optional[_Union[Party, _Mapping]] = ...) -> None: ...

class Coverage(_message.Message):
    __slots__ = ("declared_empty", "not_listed")
    DECLARED_EMPTY_FIELD_NUMBER: _ClassVar[int]
    NOT_LISTED_FIELD_NUMBER: _ClassVar[int]
    declared_empty: _containers.RepeatedCompositeFieldContainer[PartyPair]
    not_listed: int
    def __init__(self, declared_empty: _Optional[_Iterable[_Union[PartyPair, _Mapping]]] = ..., not_listed: _Optional[int] = ...) -> None: ...

class SceneSummary(_message.Message):
    __slots__ = ("name", "epoch", "revision", "bodies", "robots", "broad_phase")
    NAME_FIELD_NUMBER: _ClassVar[int]
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    BODIES_FIELD_NUMBER: _ClassVar[int]
    ROBOTS_FIELD_NUMBER: _ClassVar[int]
    BROAD_PHASE_FIELD_NUMBER: _ClassVar[int]
    name: str
    epoch: int
    revision: int
    bodies: int
    robots: int
    broad_phase: BroadPhase
    def __init__(self, name: _Optional[str] = ..., epoch: _Optional[int] = ..., revision: _Optional[int] = ..., bodies: _Optional[int] = ..., robots: _Optional[int] = ..., broad_phase: _Optional[_Union[BroadPhase, str]] = ...) -> None: ...

class Body(_message.Message):
    __slots__ = ("id", "name", "shape_kind", "pose", "groups", "layers", "mask", "bounds", "scale", "padding", "enabled")
    ID_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    SHAPE_KIND_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    GROUPS_FIELD_NUMBER: _ClassVar[int]
    LAYERS_FIELD_NUMBER: _ClassVar[int]
    MASK_FIELD_NUMBER: _ClassVar[int]
    BOUNDS_FIELD_NUMBER: _ClassVar[int]
    SCALE_FIELD_NUMBER: _ClassVar[int]
    PADDING_FIELD_NUMBER: _ClassVar[int]
    ENABLED_FIELD_NUMBER: _ClassVar[int]
    id: int
    name: str
    shape_kind: str
    pose: _geometry_pb2.Pose
    groups: _containers.RepeatedScalarFieldContainer[str]
    layers: int
    mask: int
    bounds: _geometry_pb2.Aabb
    scale: float
    padding: float
    enabled: bool
    def __init__(self, id: _Optional[int] = ..., name: _Optional[str] = ..., shape_kind: _Optional[str] = ..., pose: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ..., groups: _Optional[_Iterable[str]] = ..., layers: _Optional[int] = ..., mask: _Optional[int] = ..., bounds: _Optional[_Union[_geometry_pb2.Aabb, _Mapping]] = ..., scale: _Optional[float] = ..., padding: _Optional[float] = ..., enabled: bool = ...) -> None: ...

class RobotInScene(_message.Message):
    __slots__ = ("name", "model", "base")
    NAME_FIELD_NUMBER: _ClassVar[int]
    MODEL_FIELD_NUMBER: _ClassVar[int]
    BASE_FIELD_NUMBER: _ClassVar[int]
    name: str
    model: str
    base: _geometry_pb2.Pose
    def __init__(self, name: _Optional[str] = ..., model: _Optional[str] = ..., base: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ...) -> None: ...

class SceneContents(_message.Message):
    __slots__ = ("name", "epoch", "revision", "oldest_revision", "bodies", "robots", "broad_phase", "body_count", "bodies_left")
    NAME_FIELD_NUMBER: _ClassVar[int]
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    OLDEST_REVISION_FIELD_NUMBER: _ClassVar[int]
    BODIES_FIELD_NUMBER: _ClassVar[int]
    ROBOTS_FIELD_NUMBER: _ClassVar[int]
    BROAD_PHASE_FIELD_NUMBER: _ClassVar[int]
    BODY_COUNT_FIELD_NUMBER: _ClassVar[int]
    BODIES_LEFT_FIELD_NUMBER: _ClassVar[int]
    name: str
    epoch: int
    revision: int
    oldest_revision: int
    bodies: _containers.RepeatedCompositeFieldContainer[Body]
    robots: _containers.RepeatedCompositeFieldContainer[RobotInScene]
    broad_phase: BroadPhase
    body_count: int
    bodies_left: bool
    def __init__(self, name: _Optional[str] = ..., epoch: _Optional[int] = ..., revision: _Optional[int] = ..., oldest_revision: _Optional[int] = ..., bodies: _Optional[_Iterable[_Union[Body, _Mapping]]] = ..., robots: _Optional[_Iterable[_Union[RobotInScene, _Mapping]]] = ..., broad_phase: _Optional[_Union[BroadPhase, str]] = ..., body_count: _Optional[int] = ..., bodies_left: bool = ...) -> None: ...
