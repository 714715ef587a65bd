from clearance.v1 import cast_pb2 as _cast_pb2
from clearance.v1 import contact_pb2 as _contact_pb2
from clearance.v1 import estimate_pb2 as _estimate_pb2
from clearance.v1 import geometry_pb2 as _geometry_pb2
from clearance.v1 import health_pb2 as _health_pb2
from clearance.v1 import motion_pb2 as _motion_pb2
from clearance.v1 import query_pb2 as _query_pb2
from clearance.v1 import robot_pb2 as _robot_pb2
from clearance.v1 import scene_pb2 as _scene_pb2
from clearance.v1 import stream_pb2 as _stream_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class ErrorReason(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    ERROR_REASON_UNSPECIFIED: _ClassVar[ErrorReason]
    ERROR_REASON_INVALID_FIELD: _ClassVar[ErrorReason]
    ERROR_REASON_NOT_FOUND: _ClassVar[ErrorReason]
    ERROR_REASON_ALREADY_EXISTS: _ClassVar[ErrorReason]
    ERROR_REASON_EDIT_REFUSED: _ClassVar[ErrorReason]
    ERROR_REASON_WRONG_EPOCH: _ClassVar[ErrorReason]
    ERROR_REASON_REVISION_MOVED_ON: _ClassVar[ErrorReason]
    ERROR_REASON_REVISION_GONE: _ClassVar[ErrorReason]
    ERROR_REASON_REVISION_NOT_YET: _ClassVar[ErrorReason]
    ERROR_REASON_LIMIT_EXCEEDED: _ClassVar[ErrorReason]
    ERROR_REASON_DEADLINE_EXCEEDED: _ClassVar[ErrorReason]
    ERROR_REASON_HASH_MISMATCH: _ClassVar[ErrorReason]
    ERROR_REASON_SHUTTING_DOWN: _ClassVar[ErrorReason]
    ERROR_REASON_INTERNAL: _ClassVar[ErrorReason]
    ERROR_REASON_KEY_REUSED: _ClassVar[ErrorReason]
    ERROR_REASON_NO_TOKEN: _ClassVar[ErrorReason]
    ERROR_REASON_UNKNOWN_TOKEN: _ClassVar[ErrorReason]
    ERROR_REASON_MISSING_SCOPE: _ClassVar[ErrorReason]
    ERROR_REASON_EFFECT_NOT_DECLARED: _ClassVar[ErrorReason]
    ERROR_REASON_EFFECT_NOT_BUILT: _ClassVar[ErrorReason]
ERROR_REASON_UNSPECIFIED: ErrorReason
ERROR_REASON_INVALID_FIELD: ErrorReason
ERROR_REASON_NOT_FOUND: ErrorReason
ERROR_REASON_ALREADY_EXISTS: ErrorReason
ERROR_REASON_EDIT_REFUSED: ErrorReason
ERROR_REASON_WRONG_EPOCH: ErrorReason
ERROR_REASON_REVISION_MOVED_ON: ErrorReason
ERROR_REASON_REVISION_GONE: ErrorReason
ERROR_REASON_REVISION_NOT_YET: ErrorReason
ERROR_REASON_LIMIT_EXCEEDED: ErrorReason
ERROR_REASON_DEADLINE_EXCEEDED: ErrorReason
ERROR_REASON_HASH_MISMATCH: ErrorReason
ERROR_REASON_SHUTTING_DOWN: ErrorReason
ERROR_REASON_INTERNAL: ErrorReason
ERROR_REASON_KEY_REUSED: ErrorReason
ERROR_REASON_NO_TOKEN: ErrorReason
ERROR_REASON_UNKNOWN_TOKEN: ErrorReason
ERROR_REASON_MISSING_SCOPE: ErrorReason
ERROR_REASON_EFFECT_NOT_DECLARED: ErrorReason
ERROR_REASON_EFFECT_NOT_BUILT: ErrorReason

class CreateSceneRequest(_message.Message):
    __slots__ = ("name", "broad_phase")
    NAME_FIELD_NUMBER: _ClassVar[int]
    BROAD_PHASE_FIELD_NUMBER: _ClassVar[int]
    name: str
    broad_phase: _scene_pb2.BroadPhase
    def __init__(self, name: _Optional[str] = ..., broad_phase: _Optional[_Union[_scene_pb2.BroadPhase, str]] = ...) -> None: ...

class CreateSceneResponse(_message.Message):
    __slots__ = ("scene",)
    SCENE_FIELD_NUMBER: _ClassVar[int]
    scene: _scene_pb2.SceneSummary
    def __init__(self, scene: _Optional[_Union[_scene_pb2.SceneSummary, _Mapping]] = ...) -> None: ...

class ListScenesRequest(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class ListScenesResponse(_message.Message):
    __slots__ = ("scenes",)
    SCENES_FIELD_NUMBER: _ClassVar[int]
    scenes: _containers.RepeatedCompositeFieldContainer[_scene_pb2.SceneSummary]
    def __init__(self, scenes: _Optional[_Iterable[_Union[_scene_pb2.SceneSummary, _Mapping]]] = ...) -> None: ...

class GetSceneRequest(_message.Message):
    __slots__ = ("scene", "revision", "max_bodies", "after_body")
    SCENE_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    MAX_BODIES_FIELD_NUMBER: _ClassVar[int]
    AFTER_BODY_FIELD_NUMBER: _ClassVar[int]
    scene: str
    revision: _query_pb2.RevisionRule
    max_bodies: int
    after_body: int
    def __init__(self, scene: _Optional[str] = ..., revision: _Optional[_Union[_query_pb2.RevisionRule, _Mapping]] = ..., max_bodies: _Optional[int] = ..., after_body: _Optional[int] = ...) -> None: ...

class GetSceneResponse(_message.Message):
    __slots__ = ("scene",)
    SCENE_FIELD_NUMBER: _ClassVar[int]
    scene: _scene_pb2.SceneContents
    def __init__(self, scene: _Optional[_Union[_scene_pb2.SceneContents, _Mapping]] = ...) -> None: ...

class DeleteSceneRequest(_message.Message):
    __slots__ = ("scene",)
    SCENE_FIELD_NUMBER: _ClassVar[int]
    scene: str
    def __init__(self, scene: _Optional[str] = ...) -> None: ...

class DeleteSceneResponse(_message.Message):
    __slots__ = ("scene",)
    SCENE_FIELD_NUMBER: _ClassVar[int]
    scene: _scene_pb2.SceneSummary
    def __init__(self, scene: _Optional[_Union[_scene_pb2.SceneSummary, _Mapping]] = ...) -> None: ...

class ApplyRequest(_message.Message):
    __slots__ = ("scene", "edits", "expected_epoch", "expected_revision", "idempotency_key")
    SCENE_FIELD_NUMBER: _ClassVar[int]
    EDITS_FIELD_NUMBER: _ClassVar[int]
    EXPECTED_EPOCH_FIELD_NUMBER: _ClassVar[int]
    EXPECTED_REVISION_FIELD_NUMBER: _ClassVar[int]
    IDEMPOTENCY_KEY_FIELD_NUMBER: _ClassVar[int]
    scene: str
    edits: _containers.RepeatedCompositeFieldContainer[_scene_pb2.Edit]
    expected_epoch: int
    expected_revision: int
    idempotency_key: str
    def __init__(self, scene: _Optional[str] = ..., edits: _Optional[_Iterable[_Union[_scene_pb2.Edit, _Mapping]]] = ..., expected_epoch: _Optional[int] = ..., expected_revision: _Optional[int] = ..., idempotency_key: _Optional[str] = ...) -> None: ...

class ApplyResponse(_message.Message):
    __slots__ = ("epoch", "revision", "added")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    ADDED_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    revision: int
    added: _containers.RepeatedScalarFieldContainer[int]
    def __init__(self, epoch: _Optional[int] = ..., revision: _Optional[int] = ..., added: _Optional[_Iterable[int]] = ...) -> None: ...

class HasAssetsRequest(_message.Message):
    __slots__ = ("sha256",)
    SHA256_FIELD_NUMBER: _ClassVar[int]
    sha256: _containers.RepeatedScalarFieldContainer[str]
    def __init__(self, sha256: _Optional[_Iterable[str]] = ...) -> None: ...

class HasAssetsResponse(_message.Message):
    __slots__ = ("present",)
    PRESENT_FIELD_NUMBER: _ClassVar[int]
    present: _containers.RepeatedScalarFieldContainer[bool]
    def __init__(self, present: _Optional[_Iterable[bool]] = ...) -> None: ...

class PutAssetRequest(_message.Message):
    __slots__ = ("header", "chunk")
    HEADER_FIELD_NUMBER: _ClassVar[int]
    CHUNK_FIELD_NUMBER: _ClassVar[int]
    header: AssetHeader
    chunk: bytes
    def __init__(self, header: _Optional[_Union[AssetHeader, _Mapping]] = ..., chunk: _Optional[bytes] = ...) -> None: ...

class AssetHeader(_message.Message):
    __slots__ = ("sha256", "bytes")
    SHA256_FIELD_NUMBER: _ClassVar[int]
    BYTES_FIELD_NUMBER: _ClassVar[int]
    sha256: str
    bytes: int
    def __init__(self, sha256: _Optional[str] = ..., bytes: _Optional[int] = ...) -> None: ...

class PutAssetResponse(_message.Message):
    __slots__ = ("sha256", "bytes", "already_present")
    SHA256_FIELD_NUMBER: _ClassVar[int]
    BYTES_FIELD_NUMBER: _ClassVar[int]
    ALREADY_PRESENT_FIELD_NUMBER: _ClassVar[int]
    sha256: str
    bytes: int
    already_present: bool
    def __init__(self, sha256: _Optional[str] = ..., bytes: _Optional[int] = ..., already_present: bool = ...) -> None: ...

class DescribeMeshRequest(_message.Message):
    __slots__ = ("mesh", "accuracy")
    MESH_FIELD_NUMBER: _ClassVar[int]
    ACCURACY_FIELD_NUMBER: _ClassVar[int]
    mesh: _geometry_pb2.MeshAsset
    accuracy: float
    def __init__(self, mesh: _Optional[_Union[_geometry_pb2.MeshAsset, _Mapping]] = ..., accuracy: _Optional[float] = ...) -> None: ...

class DescribeMeshResponse(_message.Message):
    __slots__ = ("card",)
    CARD_FIELD_NUMBER: _ClassVar[int]
    card: MeshCard
    def __init__(self, card: _Optional[_Union[MeshCard, _Mapping]] = ...) -> None: ...

class MeshCard(_message.Message):
    __slots__ = ("pieces", "bytes", "build_seconds", "inflation", "loss", "closed", "points")
    PIECES_FIELD_NUMBER: _ClassVar[int]
    BYTES_FIELD_NUMBER: _ClassVar[int]
    BUILD_SECONDS_FIELD_NUMBER: _ClassVar[int]
    INFLATION_FIELD_NUMBER: _ClassVar[int]
    LOSS_FIELD_NUMBER: _ClassVar[int]
    CLOSED_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    pieces: int
    bytes: int
    build_seconds: float
    inflation: _query_pb2.Bracket
    loss: _query_pb2.Bracket
    closed: bool
    points: int
    def __init__(self, pieces: _Optional[int] = ..., bytes: _Optional[int] = ..., build_seconds: _Optional[float] = ..., inflation: _Optional[_Union[_query_pb2.Bracket, _Mapping]] = ..., loss: _Optional[_Union[_query_pb2.Bracket, _Mapping]] = ..., closed: bool = ..., points: _Optional[int] = ...) -> None: ...

class LoadRobotResponse(_message.Message):
    __slots__ = ("robot",)
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    robot: _robot_pb2.RobotModel
    def __init__(self, robot: _Optional[_Union[_robot_pb2.RobotModel, _Mapping]] = ...) -> None: ...

class ListRobotsRequest(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class ListRobotsResponse(_message.Message):
    __slots__ = ("robots",)
    ROBOTS_FIELD_NUMBER: _ClassVar[int]
    robots: _containers.RepeatedCompositeFieldContainer[RobotSummary]
    def __init__(self, robots: _Optional[_Iterable[_Union[RobotSummary, _Mapping]]] = ...) -> None: ...

class RobotSummary(_message.Message):
    __slots__ = ("id", "name")
    ID_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    id: str
    name: str
    def __init__(self, id: _Optional[str] = ..., name: _Optional[str] = ...) -> None: ...

class GetRobotRequest(_message.Message):
    __slots__ = ("id",)
    ID_FIELD_NUMBER: _ClassVar[int]
    id: str
    def __init__(self, id: _Optional[str] = ...) -> None: ...

class GetRobotResponse(_message.Message):
    __slots__ = ("robot",)
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    robot: _robot_pb2.RobotModel
    def __init__(self, robot: _Optional[_Union[_robot_pb2.RobotModel, _Mapping]] = ...) -> None: ...

class CheckStatesResponse(_message.Message):
    __slots__ = ("answer",)
    ANSWER_FIELD_NUMBER: _ClassVar[int]
    answer: _query_pb2.Answer
    def __init__(self, answer: _Optional[_Union[_query_pb2.Answer, _Mapping]] = ...) -> None: ...

class CollideResponse(_message.Message):
    __slots__ = ("answer",)
    ANSWER_FIELD_NUMBER: _ClassVar[int]
    answer: _query_pb2.Answer
    def __init__(self, answer: _Optional[_Union[_query_pb2.Answer, _Mapping]] = ...) -> None: ...

class DistanceResponse(_message.Message):
    __slots__ = ("answer",)
    ANSWER_FIELD_NUMBER: _ClassVar[int]
    answer: _query_pb2.Answer
    def __init__(self, answer: _Optional[_Union[_query_pb2.Answer, _Mapping]] = ...) -> None: ...

class QueryStreamRequest(_message.Message):
    __slots__ = ("id", "options", "check_states", "collide", "distance", "cast_rays", "cast_shapes", "check_moving_pairs", "overlap", "nearest_bodies", "check_motions", "check_path", "clearance", "estimate")
    ID_FIELD_NUMBER: _ClassVar[int]
    OPTIONS_FIELD_NUMBER: _ClassVar[int]
    CHECK_STATES_FIELD_NUMBER: _ClassVar[int]
    COLLIDE_FIELD_NUMBER: _ClassVar[int]
    DISTANCE_FIELD_NUMBER: _ClassVar[int]
    CAST_RAYS_FIELD_NUMBER: _ClassVar[int]
    CAST_SHAPES_FIELD_NUMBER: _ClassVar[int]
    CHECK_MOVING_PAIRS_FIELD_NUMBER: _ClassVar[int]
    OVERLAP_FIELD_NUMBER: _ClassVar[int]
    NEAREST_BODIES_FIELD_NUMBER: _ClassVar[int]
    CHECK_MOTIONS_FIELD_NUMBER: _ClassVar[int]
    CHECK_PATH_FIELD_NUMBER: _ClassVar[int]
    CLEARANCE_FIELD_NUMBER: _ClassVar[int]
    ESTIMATE_FIELD_NUMBER: _ClassVar[int]
    id: int
    options: QueryStreamOptions
    check_states: _query_pb2.CheckStatesRequest
    collide: _query_pb2.CollideRequest
    distance: _query_pb2.DistanceRequest
    cast_rays: _cast_pb2.CastRaysRequest
    cast_shapes: _cast_pb2.CastShapesRequest
    check_moving_pairs: _cast_pb2.CheckMovingPairsRequest
    overlap: _cast_pb2.OverlapRequest
    nearest_bodies: _cast_pb2.NearestBodiesRequest
    check_motions: _motion_pb2.CheckMotionsRequest
    check_path: _motion_pb2.CheckPathRequest
    clearance: _motion_pb2.ClearanceRequest
    estimate: _estimate_pb2.EstimateRequest
    def __init__(self, id: _Optional[int] = ..., options: _Optional[_Union[QueryStreamOptions, _Mapping]] = ..., check_states: _Optional[_Union[_query_pb2.CheckStatesRequest, _Mapping]] = ..., collide: _Optional[_Union[_query_pb2.CollideRequest, _Mapping]] = ..., distance: _Optional[_Union[_query_pb2.DistanceRequest, _Mapping]] = ..., cast_rays: _Optional[_Union[_cast_pb2.CastRaysRequest, _Mapping]] = ..., cast_shapes: _Optional[_Union[_cast_pb2.CastShapesRequest, _Mapping]] = ..., check_moving_pairs: _Optional[_Union[_cast_pb2.CheckMovingPairsRequest, _Mapping]] = ..., overlap: _Optional[_Union[_cast_pb2.OverlapRequest, _Mapping]] = ..., nearest_bodies: _Optional[_Union[_cast_pb2.NearestBodiesRequest, _Mapping]] = ..., check_motions: _Optional[_Union[_motion_pb2.CheckMotionsRequest, _Mapping]] = ..., check_path: _Optional[_Union[_motion_pb2.CheckPathRequest, _Mapping]] = ..., clearance: _Optional[_Union[_motion_pb2.ClearanceRequest, _Mapping]] = ..., estimate: _Optional[_Union[_estimate_pb2.EstimateRequest, _Mapping]] = ...) -> None: ...

class QueryStreamOptions(_message.Message):
    __slots__ = ("in_order", "max_in_flight")
    IN_ORDER_FIELD_NUMBER: _ClassVar[int]
    MAX_IN_FLIGHT_FIELD_NUMBER: _ClassVar[int]
    in_order: bool
    max_in_flight: int
    def __init__(self, in_order: bool = ..., max_in_flight: _Optional[int] = ...) -> None: ...

class QueryStreamResponse(_message.Message):
    __slots__ = ("id", "error", "check_states", "collide", "distance", "cast_rays", "cast_shapes", "check_moving_pairs", "overlap", "nearest_bodies", "check_motions", "check_path", "clearance", "estimate")
    ID_FIELD_NUMBER: _ClassVar[int]
    ERROR_FIELD_NUMBER: _ClassVar[int]
    CHECK_STATES_FIELD_NUMBER: _ClassVar[int]
    COLLIDE_FIELD_NUMBER: _ClassVar[int]
    DISTANCE_FIELD_NUMBER: _ClassVar[int]
    CAST_RAYS_FIELD_NUMBER: _ClassVar[int]
    CAST_SHAPES_FIELD_NUMBER: _ClassVar[int]
    CHECK_MOVING_PAIRS_FIELD_NUMBER: _ClassVar[int]
    OVERLAP_FIELD_NUMBER: _ClassVar[int]
    NEAREST_BODIES_FIELD_NUMBER: _ClassVar[int]
    CHECK_MOTIONS_FIELD_NUMBER: _ClassVar[int]
    CHECK_PATH_FIELD_NUMBER: _ClassVar[int]
    CLEARANCE_FIELD_NUMBER: _ClassVar[int]
    ESTIMATE_FIELD_NUMBER: _ClassVar[int]
    id: int
    error: QueryError
    check_states: CheckStatesResponse
    collide: CollideResponse
    distance: DistanceResponse
    cast_rays: _cast_pb2.CastRaysResponse
    cast_shapes: _cast_pb2.CastShapesResponse
    check_moving_pairs: _cast_pb2.CheckMovingPairsResponse
    overlap: _cast_pb2.OverlapResponse
    nearest_bodies: _cast_pb2.NearestBodiesResponse
    check_motions: _motion_pb2.CheckMotionsResponse
    check_path: _motion_pb2.CheckPathResponse
    clearance: _motion_pb2.ClearanceResponse
    estimate: _estimate_pb2.EstimateResponse
    def __init__(self, id: _Optional[int] = ..., error: _Optional[_Union[QueryError, _Mapping]] = ..., check_states: _Optional[_Union[CheckStatesResponse, _Mapping]] = ..., collide: _Optional[_Union[CollideResponse, _Mapping]] = ..., distance: _Optional[_Union[DistanceResponse, _Mapping]] = ..., cast_rays: _Optional[_Union[_cast_pb2.CastRaysResponse, _Mapping]] = ..., cast_shapes: _Optional[_Union[_cast_pb2.CastShapesResponse, _Mapping]] = ..., check_moving_pairs: _Optional[_Union[_cast_pb2.CheckMovingPairsResponse, _Mapping]] = ..., overlap: _Optional[_Union[_cast_pb2.OverlapResponse, _Mapping]] = ..., nearest_bodies: _Optional[_Union[_cast_pb2.NearestBodiesResponse, _Mapping]] = ..., check_motions: _Optional[_Union[_motion_pb2.CheckMotionsResponse, _Mapping]] = ..., check_path: _Optional[_Union[_motion_pb2.CheckPathResponse, _Mapping]] = ..., clearance: _Optional[_Union[_motion_pb2.ClearanceResponse, _Mapping]] = ..., estimate: _Optional[_Union[_estimate_pb2.EstimateResponse, _Mapping]] = ...) -> None: ...

class QueryError(_message.Message):
    __slots__ = ("code", "reason", "message", "details")
    class DetailsEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: str
        def __init__(self, key: _Optional[str] = ..., value: _Optional[str] = ...) -> None: ...
    CODE_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    MESSAGE_FIELD_NUMBER: _ClassVar[int]
    DETAILS_FIELD_NUMBER: _ClassVar[int]
    code: int
    reason: ErrorReason
    message: str
    details: _containers.ScalarMap[str, str]
    def __init__(self, code: _Optional[int] = ..., reason: _Optional[_Union[ErrorReason, str]] = ..., message: _Optional[str] = ..., details: _Optional[_Mapping[str, str]] = ...) -> None: ...

class GetServerInfoRequest(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class GetServerInfoResponse(_message.Message):
    __slots__ = ("version", "doors", "limits", "scenes", "threads")
    VERSION_FIELD_NUMBER: _ClassVar[int]
    DOORS_FIELD_NUMBER: _ClassVar[int]
    LIMITS_FIELD_NUMBER: _ClassVar[int]
    SCENES_FIELD_NUMBER: _ClassVar[int]
    THREADS_FIELD_NUMBER: _ClassVar[int]
    version: str
    doors: _containers.RepeatedCompositeFieldContainer[Door]
    limits: _containers.RepeatedCompositeFieldContainer[Limit]
    scenes: _containers.RepeatedCompositeFieldContainer[_scene_pb2.SceneSummary]
    threads: int
    def __init__(self, version: _Optional[str] = ..., doors: _Optional[_Iterable[_Union[Door, _Mapping]]] = ..., limits: _Optional[_Iterable[_Union[Limit, _Mapping]]] = ..., scenes: _Optional[_Iterable[_Union[_scene_pb2.SceneSummary, _Mapping]]] = ..., threads: _Optional[int] = ...) -> None: ...

class Door(_message.Message):
    __slots__ = ("kind", "address")
    KIND_FIELD_NUMBER: _ClassVar[int]
    ADDRESS_FIELD_NUMBER: _ClassVar[int]
    kind: str
    address: str
    def __init__(self, kind: _Optional[str] = ..., address: _Optional[str] = ...) -> None: ...

class Limit(_message.Message):
    __slots__ = ("name", "unit", "value", "what_happens")
    NAME_FIELD_NUMBER: _ClassVar[int]
    UNIT_FIELD_NUMBER: _ClassVar[int]
    VALUE_FIELD_NUMBER: _ClassVar[int]
    WHAT_HAPPENS_FIELD_NUMBER: _ClassVar[int]
    name: str
    unit: str
    value: int
    what_happens: str
    def __init__(self, name: _Optional[str] = ..., unit: _Optional[str] = ..., value: _Optional[int] = ..., what_happens: _Optional[str] = ...) -> None: ...
