from clearance.v1 import geometry_pb2 as _geometry_pb2
from clearance.v1 import query_pb2 as _query_pb2
from clearance.v1 import scene_pb2 as _scene_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class CastMode(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    CAST_MODE_UNSPECIFIED: _ClassVar[CastMode]
    CAST_MODE_FIRST: _ClassVar[CastMode]
    CAST_MODE_ALL: _ClassVar[CastMode]
    CAST_MODE_ANY: _ClassVar[CastMode]

class CastVerdict(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    CAST_VERDICT_UNSPECIFIED: _ClassVar[CastVerdict]
    CAST_VERDICT_CLEAR: _ClassVar[CastVerdict]
    CAST_VERDICT_HIT: _ClassVar[CastVerdict]
    CAST_VERDICT_INDETERMINATE: _ClassVar[CastVerdict]
    CAST_VERDICT_NOT_RUN: _ClassVar[CastVerdict]
    CAST_VERDICT_INVALID_INPUT: _ClassVar[CastVerdict]
CAST_MODE_UNSPECIFIED: CastMode
CAST_MODE_FIRST: CastMode
CAST_MODE_ALL: CastMode
CAST_MODE_ANY: CastMode
CAST_VERDICT_UNSPECIFIED: CastVerdict
CAST_VERDICT_CLEAR: CastVerdict
CAST_VERDICT_HIT: CastVerdict
CAST_VERDICT_INDETERMINATE: CastVerdict
CAST_VERDICT_NOT_RUN: CastVerdict
CAST_VERDICT_INVALID_INPUT: CastVerdict

class CastRaysRequest(_message.Message):
    __slots__ = ("context", "origins", "directions", "lengths", "mode")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    ORIGINS_FIELD_NUMBER: _ClassVar[int]
    DIRECTIONS_FIELD_NUMBER: _ClassVar[int]
    LENGTHS_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    context: _query_pb2.Context
    origins: _geometry_pb2.Doubles
    directions: _geometry_pb2.Doubles
    lengths: _geometry_pb2.Doubles
    mode: CastMode
    def __init__(self, context: _Optional[_Union[_query_pb2.Context, _Mapping]] = ..., origins: _Optional[_Union[_geometry_pb2.Doubles, _Mapping]] = ..., directions: _Optional[_Union[_geometry_pb2.Doubles, _Mapping]] = ..., lengths: _Optional[_Union[_geometry_pb2.Doubles, _Mapping]] = ..., mode: _Optional[_Union[CastMode, str]] = ...) -> None: ...

class CastRaysResponse(_message.Message):
    __slots__ = ("epoch", "revision", "out_of_time", "verdicts", "indeterminacies", "free_until", "truncated", "hit_counts", "hits", "grazed_counts", "grazed", "problems", "cost")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    OUT_OF_TIME_FIELD_NUMBER: _ClassVar[int]
    VERDICTS_FIELD_NUMBER: _ClassVar[int]
    INDETERMINACIES_FIELD_NUMBER: _ClassVar[int]
    FREE_UNTIL_FIELD_NUMBER: _ClassVar[int]
    TRUNCATED_FIELD_NUMBER: _ClassVar[int]
    HIT_COUNTS_FIELD_NUMBER: _ClassVar[int]
    HITS_FIELD_NUMBER: _ClassVar[int]
    GRAZED_COUNTS_FIELD_NUMBER: _ClassVar[int]
    GRAZED_FIELD_NUMBER: _ClassVar[int]
    PROBLEMS_FIELD_NUMBER: _ClassVar[int]
    COST_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    revision: int
    out_of_time: bool
    verdicts: bytes
    indeterminacies: bytes
    free_until: bytes
    truncated: bytes
    hit_counts: bytes
    hits: RayHits
    grazed_counts: bytes
    grazed: GrazedBodies
    problems: _containers.RepeatedCompositeFieldContainer[_query_pb2.BulkProblem]
    cost: _query_pb2.Cost
    def __init__(self, epoch: _Optional[int] = ..., revision: _Optional[int] = ..., out_of_time: bool = ..., verdicts: _Optional[bytes] = ..., indeterminacies: _Optional[bytes] = ..., free_until: _Optional[bytes] = ..., truncated: _Optional[bytes] = ..., hit_counts: _Optional[bytes] = ..., hits: _Optional[_Union[RayHits, _Mapping]] = ..., grazed_counts: _Optional[bytes] = ..., grazed: _Optional[_Union[GrazedBodies, _Mapping]] = ..., problems: _Optional[_Iterable[_Union[_query_pb2.BulkProblem, _Mapping]]] = ..., cost: _Optional[_Union[_query_pb2.Cost, _Mapping]] = ...) -> None: ...

class RayHits(_message.Message):
    __slots__ = ("bodies", "subshapes", "lower", "upper", "at_start", "points", "normals")
    BODIES_FIELD_NUMBER: _ClassVar[int]
    SUBSHAPES_FIELD_NUMBER: _ClassVar[int]
    LOWER_FIELD_NUMBER: _ClassVar[int]
    UPPER_FIELD_NUMBER: _ClassVar[int]
    AT_START_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    NORMALS_FIELD_NUMBER: _ClassVar[int]
    bodies: bytes
    subshapes: bytes
    lower: bytes
    upper: bytes
    at_start: bytes
    points: bytes
    normals: bytes
    def __init__(self, bodies: _Optional[bytes] = ..., subshapes: _Optional[bytes] = ..., lower: _Optional[bytes] = ..., upper: _Optional[bytes] = ..., at_start: _Optional[bytes] = ..., points: _Optional[bytes] = ..., normals: _Optional[bytes] = ...) -> None: ...

class GrazedBodies(_message.Message):
    __slots__ = ("bodies", "lower", "upper", "indeterminacies")
    BODIES_FIELD_NUMBER: _ClassVar[int]
    LOWER_FIELD_NUMBER: _ClassVar[int]
    UPPER_FIELD_NUMBER: _ClassVar[int]
    INDETERMINACIES_FIELD_NUMBER: _ClassVar[int]
    bodies: bytes
    lower: bytes
    upper: bytes
    indeterminacies: bytes
    def __init__(self, bodies: _Optional[bytes] = ..., lower: _Optional[bytes] = ..., upper: _Optional[bytes] = ..., indeterminacies: _Optional[bytes] = ...) -> None: ...

class Mover(_message.Message):
    __slots__ = ("shape", "body", "start", "still", "to", "by")
    SHAPE_FIELD_NUMBER: _ClassVar[int]
    BODY_FIELD_NUMBER: _ClassVar[int]
    START_FIELD_NUMBER: _ClassVar[int]
    STILL_FIELD_NUMBER: _ClassVar[int]
    TO_FIELD_NUMBER: _ClassVar[int]
    BY_FIELD_NUMBER: _ClassVar[int]
    shape: _geometry_pb2.Shape
    body: _scene_pb2.BodyRef
    start: _geometry_pb2.Pose
    still: Still
    to: _geometry_pb2.Pose
    by: Twist
    def __init__(self, shape: _Optional[_Union[_geometry_pb2.Shape, _Mapping]] = ..., body: _Optional[_Union[_scene_pb2.BodyRef, _Mapping]] = ..., start: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ..., still: _Optional[_Union[Still, _Mapping]] = ..., to: _Optional[_Union[_geometry_pb2.Pose, _Mapping]] = ..., by: _Optional[_Union[Twist, _Mapping]] = ...) -> None: ...

class Still(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class Twist(_message.Message):
    __slots__ = ("displacement", "turn")
    DISPLACEMENT_FIELD_NUMBER: _ClassVar[int]
    TURN_FIELD_NUMBER: _ClassVar[int]
    displacement: _geometry_pb2.Vec3
    turn: _geometry_pb2.Vec3
    def __init__(self, displacement: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ..., turn: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ...) -> None: ...

class CastShapesRequest(_message.Message):
    __slots__ = ("context", "items", "mode", "resolution")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    RESOLUTION_FIELD_NUMBER: _ClassVar[int]
    context: _query_pb2.Context
    items: _containers.RepeatedCompositeFieldContainer[Mover]
    mode: CastMode
    resolution: float
    def __init__(self, context: _Optional[_Union[_query_pb2.Context, _Mapping]] = ..., items: _Optional[_Iterable[_Union[Mover, _Mapping]]] = ..., mode: _Optional[_Union[CastMode, str]] = ..., resolution: _Optional[float] = ...) -> None: ...

class CheckMovingPairsRequest(_message.Message):
    __slots__ = ("context", "items", "resolution")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    RESOLUTION_FIELD_NUMBER: _ClassVar[int]
    context: _query_pb2.Context
    items: _containers.RepeatedCompositeFieldContainer[MovingPair]
    resolution: float
    def __init__(self, context: _Optional[_Union[_query_pb2.Context, _Mapping]] = ..., items: _Optional[_Iterable[_Union[MovingPair, _Mapping]]] = ..., resolution: _Optional[float] = ...) -> None: ...

class MovingPair(_message.Message):
    __slots__ = ("a", "b")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    a: Mover
    b: Mover
    def __init__(self, a: _Optional[_Union[Mover, _Mapping]] = ..., b: _Optional[_Union[Mover, _Mapping]] = ...) -> None: ...

class CastHit(_message.Message):
    __slots__ = ("body", "subshape", "own_subshape", "lower", "upper", "at_start", "point", "normal")
    BODY_FIELD_NUMBER: _ClassVar[int]
    SUBSHAPE_FIELD_NUMBER: _ClassVar[int]
    OWN_SUBSHAPE_FIELD_NUMBER: _ClassVar[int]
    LOWER_FIELD_NUMBER: _ClassVar[int]
    UPPER_FIELD_NUMBER: _ClassVar[int]
    AT_START_FIELD_NUMBER: _ClassVar[int]
    POINT_FIELD_NUMBER: _ClassVar[int]
    NORMAL_FIELD_NUMBER: _ClassVar[int]
    body: int
    subshape: int
    own_subshape: int
    lower: float
    upper: float
    at_start: bool
    point: _geometry_pb2.Vec3
    normal: _geometry_pb2.Vec3
    def __init__(self, body: _Optional[int] = ..., subshape: _Optional[int] = ..., own_subshape: _Optional[int] = ..., lower: _Optional[float] = ..., upper: _Optional[float] = ..., at_start: bool = ..., point: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ..., normal: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ...) -> None: ...

class Grazed(_message.Message):
    __slots__ = ("body", "lower", "upper", "indeterminacy")
    BODY_FIELD_NUMBER: _ClassVar[int]
    LOWER_FIELD_NUMBER: _ClassVar[int]
    UPPER_FIELD_NUMBER: _ClassVar[int]
    INDETERMINACY_FIELD_NUMBER: _ClassVar[int]
    body: int
    lower: float
    upper: float
    indeterminacy: _query_pb2.Indeterminacy
    def __init__(self, body: _Optional[int] = ..., lower: _Optional[float] = ..., upper: _Optional[float] = ..., indeterminacy: _Optional[_Union[_query_pb2.Indeterminacy, str]] = ...) -> None: ...

class CastItem(_message.Message):
    __slots__ = ("verdict", "indeterminacy", "free_until", "hits", "grazed", "truncated", "problem", "cost")
    VERDICT_FIELD_NUMBER: _ClassVar[int]
    INDETERMINACY_FIELD_NUMBER: _ClassVar[int]
    FREE_UNTIL_FIELD_NUMBER: _ClassVar[int]
    HITS_FIELD_NUMBER: _ClassVar[int]
    GRAZED_FIELD_NUMBER: _ClassVar[int]
    TRUNCATED_FIELD_NUMBER: _ClassVar[int]
    PROBLEM_FIELD_NUMBER: _ClassVar[int]
    COST_FIELD_NUMBER: _ClassVar[int]
    verdict: CastVerdict
    indeterminacy: _query_pb2.Indeterminacy
    free_until: float
    hits: _containers.RepeatedCompositeFieldContainer[CastHit]
    grazed: _containers.RepeatedCompositeFieldContainer[Grazed]
    truncated: bool
    problem: str
    cost: _query_pb2.Cost
    def __init__(self, verdict: _Optional[_Union[CastVerdict, str]] = ..., indeterminacy: _Optional[_Union[_query_pb2.Indeterminacy, str]] = ..., free_until: _Optional[float] = ..., hits: _Optional[_Iterable[_Union[CastHit, _Mapping]]] = ..., grazed: _Optional[_Iterable[_Union[Grazed, _Mapping]]] = ..., truncated: bool = ..., problem: _Optional[str] = ..., cost: _Optional[_Union[_query_pb2.Cost, _Mapping]] = ...) -> None: ...

class CastShapesResponse(_message.Message):
    __slots__ = ("epoch", "revision", "out_of_time", "items", "coverage")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    OUT_OF_TIME_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    COVERAGE_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    revision: int
    out_of_time: bool
    items: _containers.RepeatedCompositeFieldContainer[CastItem]
    coverage: _scene_pb2.Coverage
    def __init__(self, epoch: _Optional[int] = ..., revision: _Optional[int] = ..., out_of_time: bool = ..., items: _Optional[_Iterable[_Union[CastItem, _Mapping]]] = ..., coverage: _Optional[_Union[_scene_pb2.Coverage, _Mapping]] = ...) -> None: ...

class CheckMovingPairsResponse(_message.Message):
    __slots__ = ("epoch", "revision", "out_of_time", "items", "coverage")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    OUT_OF_TIME_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    COVERAGE_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    revision: int
    out_of_time: bool
    items: _containers.RepeatedCompositeFieldContainer[CastItem]
    coverage: _scene_pb2.Coverage
    def __init__(self, epoch: _Optional[int] = ..., revision: _Optional[int] = ..., out_of_time: bool = ..., items: _Optional[_Iterable[_Union[CastItem, _Mapping]]] = ..., coverage: _Optional[_Union[_scene_pb2.Coverage, _Mapping]] = ...) -> None: ...

class Region(_message.Message):
    __slots__ = ("box", "ball", "shape")
    BOX_FIELD_NUMBER: _ClassVar[int]
    BALL_FIELD_NUMBER: _ClassVar[int]
    SHAPE_FIELD_NUMBER: _ClassVar[int]
    box: _geometry_pb2.Aabb
    ball: RegionBall
    shape: _query_pb2.PlacedShape
    def __init__(self, box: _Optional[_Union[_geometry_pb2.Aabb, _Mapping]] = ..., ball: _Optional[_Union[RegionBall, _Mapping]] = ..., shape: _Optional[_Union[_query_pb2.PlacedShape, _Mapping]] = ...) -> None: ...

class RegionBall(_message.Message):
    __slots__ = ("center", "radius")
    CENTER_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    center: _geometry_pb2.Vec3
    radius: float
    def __init__(self, center: _Optional[_Union[_geometry_pb2.Vec3, _Mapping]] = ..., radius: _Optional[float] = ...) -> None: ...

class OverlapRequest(_message.Message):
    __slots__ = ("context", "items", "bounds_only")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    BOUNDS_ONLY_FIELD_NUMBER: _ClassVar[int]
    context: _query_pb2.Context
    items: _containers.RepeatedCompositeFieldContainer[Region]
    bounds_only: bool
    def __init__(self, context: _Optional[_Union[_query_pb2.Context, _Mapping]] = ..., items: _Optional[_Iterable[_Union[Region, _Mapping]]] = ..., bounds_only: bool = ...) -> None: ...

class OverlapItem(_message.Message):
    __slots__ = ("verdict", "indeterminacy", "bodies", "verdicts", "truncated", "problem", "cost")
    VERDICT_FIELD_NUMBER: _ClassVar[int]
    INDETERMINACY_FIELD_NUMBER: _ClassVar[int]
    BODIES_FIELD_NUMBER: _ClassVar[int]
    VERDICTS_FIELD_NUMBER: _ClassVar[int]
    TRUNCATED_FIELD_NUMBER: _ClassVar[int]
    PROBLEM_FIELD_NUMBER: _ClassVar[int]
    COST_FIELD_NUMBER: _ClassVar[int]
    verdict: _query_pb2.Verdict
    indeterminacy: _query_pb2.Indeterminacy
    bodies: _containers.RepeatedScalarFieldContainer[int]
    verdicts: bytes
    truncated: bool
    problem: str
    cost: _query_pb2.Cost
    def __init__(self, verdict: _Optional[_Union[_query_pb2.Verdict, str]] = ..., indeterminacy: _Optional[_Union[_query_pb2.Indeterminacy, str]] = ..., bodies: _Optional[_Iterable[int]] = ..., verdicts: _Optional[bytes] = ..., truncated: bool = ..., problem: _Optional[str] = ..., cost: _Optional[_Union[_query_pb2.Cost, _Mapping]] = ...) -> None: ...

class OverlapResponse(_message.Message):
    __slots__ = ("epoch", "revision", "out_of_time", "items")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    OUT_OF_TIME_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    revision: int
    out_of_time: bool
    items: _containers.RepeatedCompositeFieldContainer[OverlapItem]
    def __init__(self, epoch: _Optional[int] = ..., revision: _Optional[int] = ..., out_of_time: bool = ..., items: _Optional[_Iterable[_Union[OverlapItem, _Mapping]]] = ...) -> None: ...

class NearestBodiesRequest(_message.Message):
    __slots__ = ("context", "items", "count")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    COUNT_FIELD_NUMBER: _ClassVar[int]
    context: _query_pb2.Context
    items: _containers.RepeatedCompositeFieldContainer[_query_pb2.Subject]
    count: int
    def __init__(self, context: _Optional[_Union[_query_pb2.Context, _Mapping]] = ..., items: _Optional[_Iterable[_Union[_query_pb2.Subject, _Mapping]]] = ..., count: _Optional[int] = ...) -> None: ...

class NearestItem(_message.Message):
    __slots__ = ("verdict", "indeterminacy", "nearest", "set_is_proved", "order_is_proved", "problem", "cost")
    VERDICT_FIELD_NUMBER: _ClassVar[int]
    INDETERMINACY_FIELD_NUMBER: _ClassVar[int]
    NEAREST_FIELD_NUMBER: _ClassVar[int]
    SET_IS_PROVED_FIELD_NUMBER: _ClassVar[int]
    ORDER_IS_PROVED_FIELD_NUMBER: _ClassVar[int]
    PROBLEM_FIELD_NUMBER: _ClassVar[int]
    COST_FIELD_NUMBER: _ClassVar[int]
    verdict: _query_pb2.Verdict
    indeterminacy: _query_pb2.Indeterminacy
    nearest: _containers.RepeatedCompositeFieldContainer[_query_pb2.PairAnswer]
    set_is_proved: bool
    order_is_proved: bool
    problem: str
    cost: _query_pb2.Cost
    def __init__(self, verdict: _Optional[_Union[_query_pb2.Verdict, str]] = ..., indeterminacy: _Optional[_Union[_query_pb2.Indeterminacy, str]] = ..., nearest: _Optional[_Iterable[_Union[_query_pb2.PairAnswer, _Mapping]]] = ..., set_is_proved: bool = ..., order_is_proved: bool = ..., problem: _Optional[str] = ..., cost: _Optional[_Union[_query_pb2.Cost, _Mapping]] = ...) -> None: ...

class NearestBodiesResponse(_message.Message):
    __slots__ = ("epoch", "revision", "out_of_time", "items", "coverage")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    OUT_OF_TIME_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    COVERAGE_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    revision: int
    out_of_time: bool
    items: _containers.RepeatedCompositeFieldContainer[NearestItem]
    coverage: _scene_pb2.Coverage
    def __init__(self, epoch: _Optional[int] = ..., revision: _Optional[int] = ..., out_of_time: bool = ..., items: _Optional[_Iterable[_Union[NearestItem, _Mapping]]] = ..., coverage: _Optional[_Union[_scene_pb2.Coverage, _Mapping]] = ...) -> None: ...
