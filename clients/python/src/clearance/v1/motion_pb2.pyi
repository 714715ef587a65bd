from clearance.v1 import geometry_pb2 as _geometry_pb2
from clearance.v1 import query_pb2 as _query_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Find(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    FIND_UNSPECIFIED: _ClassVar[Find]
    FIND_FIRST_CONTACT: _ClassVar[Find]
    FIND_ANY_CONTACT: _ClassVar[Find]
FIND_UNSPECIFIED: Find
FIND_FIRST_CONTACT: Find
FIND_ANY_CONTACT: Find

class MotionEffort(_message.Message):
    __slots__ = ("find", "resolution", "max_states")
    FIND_FIELD_NUMBER: _ClassVar[int]
    RESOLUTION_FIELD_NUMBER: _ClassVar[int]
    MAX_STATES_FIELD_NUMBER: _ClassVar[int]
    find: Find
    resolution: float
    max_states: int
    def __init__(self, find: _Optional[_Union[Find, str]] = ..., resolution: _Optional[float] = ..., max_states: _Optional[int] = ...) -> None: ...

class CheckMotionsRequest(_message.Message):
    __slots__ = ("context", "robot", "positions", "mode", "effort")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    POSITIONS_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    EFFORT_FIELD_NUMBER: _ClassVar[int]
    context: _query_pb2.Context
    robot: str
    positions: _geometry_pb2.Doubles
    mode: _query_pb2.Mode
    effort: MotionEffort
    def __init__(self, context: _Optional[_Union[_query_pb2.Context, _Mapping]] = ..., robot: _Optional[str] = ..., positions: _Optional[_Union[_geometry_pb2.Doubles, _Mapping]] = ..., mode: _Optional[_Union[_query_pb2.Mode, str]] = ..., effort: _Optional[_Union[MotionEffort, _Mapping]] = ...) -> None: ...

class CheckPathRequest(_message.Message):
    __slots__ = ("context", "robot", "waypoints", "mode", "effort")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    WAYPOINTS_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    EFFORT_FIELD_NUMBER: _ClassVar[int]
    context: _query_pb2.Context
    robot: str
    waypoints: _geometry_pb2.Doubles
    mode: _query_pb2.Mode
    effort: MotionEffort
    def __init__(self, context: _Optional[_Union[_query_pb2.Context, _Mapping]] = ..., robot: _Optional[str] = ..., waypoints: _Optional[_Union[_geometry_pb2.Doubles, _Mapping]] = ..., mode: _Optional[_Union[_query_pb2.Mode, str]] = ..., effort: _Optional[_Union[MotionEffort, _Mapping]] = ...) -> None: ...

class Motion(_message.Message):
    __slots__ = ("free_until", "reached", "undecided", "states", "intervals")
    FREE_UNTIL_FIELD_NUMBER: _ClassVar[int]
    REACHED_FIELD_NUMBER: _ClassVar[int]
    UNDECIDED_FIELD_NUMBER: _ClassVar[int]
    STATES_FIELD_NUMBER: _ClassVar[int]
    INTERVALS_FIELD_NUMBER: _ClassVar[int]
    free_until: float
    reached: Stretch
    undecided: Stretch
    states: int
    intervals: int
    def __init__(self, free_until: _Optional[float] = ..., reached: _Optional[_Union[Stretch, _Mapping]] = ..., undecided: _Optional[_Union[Stretch, _Mapping]] = ..., states: _Optional[int] = ..., intervals: _Optional[int] = ...) -> None: ...

class Stretch(_message.Message):
    __slots__ = ("to",)
    FROM_FIELD_NUMBER: _ClassVar[int]
    TO_FIELD_NUMBER: _ClassVar[int]
    to: float
    def __init__(self, to: _Optional[float] = ..., **kwargs) -> None: ...

class BulkMotions(_message.Message):
    __slots__ = ("free_until", "reached_from", "reached_to", "undecided_from", "undecided_to", "states")
    FREE_UNTIL_FIELD_NUMBER: _ClassVar[int]
    REACHED_FROM_FIELD_NUMBER: _ClassVar[int]
    REACHED_TO_FIELD_NUMBER: _ClassVar[int]
    UNDECIDED_FROM_FIELD_NUMBER: _ClassVar[int]
    UNDECIDED_TO_FIELD_NUMBER: _ClassVar[int]
    STATES_FIELD_NUMBER: _ClassVar[int]
    free_until: bytes
    reached_from: bytes
    reached_to: bytes
    undecided_from: bytes
    undecided_to: bytes
    states: bytes
    def __init__(self, free_until: _Optional[bytes] = ..., reached_from: _Optional[bytes] = ..., reached_to: _Optional[bytes] = ..., undecided_from: _Optional[bytes] = ..., undecided_to: _Optional[bytes] = ..., states: _Optional[bytes] = ...) -> None: ...

class CheckMotionsResponse(_message.Message):
    __slots__ = ("answer", "motions", "bulk")
    ANSWER_FIELD_NUMBER: _ClassVar[int]
    MOTIONS_FIELD_NUMBER: _ClassVar[int]
    BULK_FIELD_NUMBER: _ClassVar[int]
    answer: _query_pb2.Answer
    motions: _containers.RepeatedCompositeFieldContainer[Motion]
    bulk: BulkMotions
    def __init__(self, answer: _Optional[_Union[_query_pb2.Answer, _Mapping]] = ..., motions: _Optional[_Iterable[_Union[Motion, _Mapping]]] = ..., bulk: _Optional[_Union[BulkMotions, _Mapping]] = ...) -> None: ...

class CheckPathResponse(_message.Message):
    __slots__ = ("answer", "motions", "bulk")
    ANSWER_FIELD_NUMBER: _ClassVar[int]
    MOTIONS_FIELD_NUMBER: _ClassVar[int]
    BULK_FIELD_NUMBER: _ClassVar[int]
    answer: _query_pb2.Answer
    motions: _containers.RepeatedCompositeFieldContainer[Motion]
    bulk: BulkMotions
    def __init__(self, answer: _Optional[_Union[_query_pb2.Answer, _Mapping]] = ..., motions: _Optional[_Iterable[_Union[Motion, _Mapping]]] = ..., bulk: _Optional[_Union[BulkMotions, _Mapping]] = ...) -> None: ...

class ClearanceRequest(_message.Message):
    __slots__ = ("context", "within", "mode", "states", "items")
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    WITHIN_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    STATES_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    context: _query_pb2.Context
    within: float
    mode: _query_pb2.Mode
    states: RobotStates
    items: ClearanceSubjects
    def __init__(self, context: _Optional[_Union[_query_pb2.Context, _Mapping]] = ..., within: _Optional[float] = ..., mode: _Optional[_Union[_query_pb2.Mode, str]] = ..., states: _Optional[_Union[RobotStates, _Mapping]] = ..., items: _Optional[_Union[ClearanceSubjects, _Mapping]] = ...) -> None: ...

class RobotStates(_message.Message):
    __slots__ = ("robot", "positions")
    ROBOT_FIELD_NUMBER: _ClassVar[int]
    POSITIONS_FIELD_NUMBER: _ClassVar[int]
    robot: str
    positions: _geometry_pb2.Doubles
    def __init__(self, robot: _Optional[str] = ..., positions: _Optional[_Union[_geometry_pb2.Doubles, _Mapping]] = ...) -> None: ...

class ClearanceSubjects(_message.Message):
    __slots__ = ("items",)
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    items: _containers.RepeatedCompositeFieldContainer[_query_pb2.Subject]
    def __init__(self, items: _Optional[_Iterable[_Union[_query_pb2.Subject, _Mapping]]] = ...) -> None: ...

class ClearanceResponse(_message.Message):
    __slots__ = ("answer",)
    ANSWER_FIELD_NUMBER: _ClassVar[int]
    answer: _query_pb2.Answer
    def __init__(self, answer: _Optional[_Union[_query_pb2.Answer, _Mapping]] = ...) -> None: ...
