from clearance.v1 import motion_pb2 as _motion_pb2
from clearance.v1 import query_pb2 as _query_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Output(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    OUTPUT_UNSPECIFIED: _ClassVar[Output]
    OUTPUT_VERDICT: _ClassVar[Output]
    OUTPUT_PAIRS: _ClassVar[Output]
    OUTPUT_DISTANCE: _ClassVar[Output]
    OUTPUT_WITNESS: _ClassVar[Output]
    OUTPUT_DEPTH: _ClassVar[Output]
    OUTPUT_PATCH: _ClassVar[Output]
    OUTPUT_DERIVATIVES: _ClassVar[Output]

class EstimateEnd(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    ESTIMATE_END_UNSPECIFIED: _ClassVar[EstimateEnd]
    ESTIMATE_END_COMPLETE: _ClassVar[EstimateEnd]
    ESTIMATE_END_TIME: _ClassVar[EstimateEnd]
    ESTIMATE_END_DEADLINE: _ClassVar[EstimateEnd]
OUTPUT_UNSPECIFIED: Output
OUTPUT_VERDICT: Output
OUTPUT_PAIRS: Output
OUTPUT_DISTANCE: Output
OUTPUT_WITNESS: Output
OUTPUT_DEPTH: Output
OUTPUT_PATCH: Output
OUTPUT_DERIVATIVES: Output
ESTIMATE_END_UNSPECIFIED: EstimateEnd
ESTIMATE_END_COMPLETE: EstimateEnd
ESTIMATE_END_TIME: EstimateEnd
ESTIMATE_END_DEADLINE: EstimateEnd

class EstimateRequest(_message.Message):
    __slots__ = ("check_states", "collide", "distance", "check_motions", "check_path", "clearance", "tolerances", "outputs", "sample", "time")
    CHECK_STATES_FIELD_NUMBER: _ClassVar[int]
    COLLIDE_FIELD_NUMBER: _ClassVar[int]
    DISTANCE_FIELD_NUMBER: _ClassVar[int]
    CHECK_MOTIONS_FIELD_NUMBER: _ClassVar[int]
    CHECK_PATH_FIELD_NUMBER: _ClassVar[int]
    CLEARANCE_FIELD_NUMBER: _ClassVar[int]
    TOLERANCES_FIELD_NUMBER: _ClassVar[int]
    OUTPUTS_FIELD_NUMBER: _ClassVar[int]
    SAMPLE_FIELD_NUMBER: _ClassVar[int]
    TIME_FIELD_NUMBER: _ClassVar[int]
    check_states: _query_pb2.CheckStatesRequest
    collide: _query_pb2.CollideRequest
    distance: _query_pb2.DistanceRequest
    check_motions: _motion_pb2.CheckMotionsRequest
    check_path: _motion_pb2.CheckPathRequest
    clearance: _motion_pb2.ClearanceRequest
    tolerances: _containers.RepeatedScalarFieldContainer[float]
    outputs: _containers.RepeatedScalarFieldContainer[Output]
    sample: int
    time: float
    def __init__(self, check_states: _Optional[_Union[_query_pb2.CheckStatesRequest, _Mapping]] = ..., collide: _Optional[_Union[_query_pb2.CollideRequest, _Mapping]] = ..., distance: _Optional[_Union[_query_pb2.DistanceRequest, _Mapping]] = ..., check_motions: _Optional[_Union[_motion_pb2.CheckMotionsRequest, _Mapping]] = ..., check_path: _Optional[_Union[_motion_pb2.CheckPathRequest, _Mapping]] = ..., clearance: _Optional[_Union[_motion_pb2.ClearanceRequest, _Mapping]] = ..., tolerances: _Optional[_Iterable[float]] = ..., outputs: _Optional[_Iterable[_Union[Output, str]]] = ..., sample: _Optional[int] = ..., time: _Optional[float] = ...) -> None: ...

class EstimateResponse(_message.Message):
    __slots__ = ("epoch", "revision", "items", "sample", "turns", "asked", "seconds", "end", "rows")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    REVISION_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    SAMPLE_FIELD_NUMBER: _ClassVar[int]
    TURNS_FIELD_NUMBER: _ClassVar[int]
    ASKED_FIELD_NUMBER: _ClassVar[int]
    SECONDS_FIELD_NUMBER: _ClassVar[int]
    END_FIELD_NUMBER: _ClassVar[int]
    ROWS_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    revision: int
    items: int
    sample: int
    turns: int
    asked: int
    seconds: float
    end: EstimateEnd
    rows: _containers.RepeatedCompositeFieldContainer[Price]
    def __init__(self, epoch: _Optional[int] = ..., revision: _Optional[int] = ..., items: _Optional[int] = ..., sample: _Optional[int] = ..., turns: _Optional[int] = ..., asked: _Optional[int] = ..., seconds: _Optional[float] = ..., end: _Optional[_Union[EstimateEnd, str]] = ..., rows: _Optional[_Iterable[_Union[Price, _Mapping]]] = ...) -> None: ...

class Price(_message.Message):
    __slots__ = ("output", "tolerance", "items", "complete", "verdicts", "times", "widths", "mean_cost")
    OUTPUT_FIELD_NUMBER: _ClassVar[int]
    TOLERANCE_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    COMPLETE_FIELD_NUMBER: _ClassVar[int]
    VERDICTS_FIELD_NUMBER: _ClassVar[int]
    TIMES_FIELD_NUMBER: _ClassVar[int]
    WIDTHS_FIELD_NUMBER: _ClassVar[int]
    MEAN_COST_FIELD_NUMBER: _ClassVar[int]
    output: Output
    tolerance: float
    items: int
    complete: bool
    verdicts: VerdictCounts
    times: ItemTimes
    widths: ItemWidths
    mean_cost: MeanCost
    def __init__(self, output: _Optional[_Union[Output, str]] = ..., tolerance: _Optional[float] = ..., items: _Optional[int] = ..., complete: bool = ..., verdicts: _Optional[_Union[VerdictCounts, _Mapping]] = ..., times: _Optional[_Union[ItemTimes, _Mapping]] = ..., widths: _Optional[_Union[ItemWidths, _Mapping]] = ..., mean_cost: _Optional[_Union[MeanCost, _Mapping]] = ...) -> None: ...

class VerdictCounts(_message.Message):
    __slots__ = ("free", "margin", "collision", "rounding", "iteration_limit", "time_limit", "resolution", "not_run", "invalid_input")
    FREE_FIELD_NUMBER: _ClassVar[int]
    MARGIN_FIELD_NUMBER: _ClassVar[int]
    COLLISION_FIELD_NUMBER: _ClassVar[int]
    ROUNDING_FIELD_NUMBER: _ClassVar[int]
    ITERATION_LIMIT_FIELD_NUMBER: _ClassVar[int]
    TIME_LIMIT_FIELD_NUMBER: _ClassVar[int]
    RESOLUTION_FIELD_NUMBER: _ClassVar[int]
    NOT_RUN_FIELD_NUMBER: _ClassVar[int]
    INVALID_INPUT_FIELD_NUMBER: _ClassVar[int]
    free: int
    margin: int
    collision: int
    rounding: int
    iteration_limit: int
    time_limit: int
    resolution: int
    not_run: int
    invalid_input: int
    def __init__(self, free: _Optional[int] = ..., margin: _Optional[int] = ..., collision: _Optional[int] = ..., rounding: _Optional[int] = ..., iteration_limit: _Optional[int] = ..., time_limit: _Optional[int] = ..., resolution: _Optional[int] = ..., not_run: _Optional[int] = ..., invalid_input: _Optional[int] = ...) -> None: ...

class ItemTimes(_message.Message):
    __slots__ = ("median", "p99")
    MEDIAN_FIELD_NUMBER: _ClassVar[int]
    P99_FIELD_NUMBER: _ClassVar[int]
    median: int
    p99: int
    def __init__(self, median: _Optional[int] = ..., p99: _Optional[int] = ...) -> None: ...

class ItemWidths(_message.Message):
    __slots__ = ("items", "median", "largest", "wider")
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    MEDIAN_FIELD_NUMBER: _ClassVar[int]
    LARGEST_FIELD_NUMBER: _ClassVar[int]
    WIDER_FIELD_NUMBER: _ClassVar[int]
    items: int
    median: float
    largest: float
    wider: int
    def __init__(self, items: _Optional[int] = ..., median: _Optional[float] = ..., largest: _Optional[float] = ..., wider: _Optional[int] = ...) -> None: ...

class MeanCost(_message.Message):
    __slots__ = ("supports", "gjk_iterations", "epa_iterations", "nodes", "pairs", "escalations", "patch_corners", "patch_cuts", "derivative_separations", "derivative_supports", "derivative_corners")
    SUPPORTS_FIELD_NUMBER: _ClassVar[int]
    GJK_ITERATIONS_FIELD_NUMBER: _ClassVar[int]
    EPA_ITERATIONS_FIELD_NUMBER: _ClassVar[int]
    NODES_FIELD_NUMBER: _ClassVar[int]
    PAIRS_FIELD_NUMBER: _ClassVar[int]
    ESCALATIONS_FIELD_NUMBER: _ClassVar[int]
    PATCH_CORNERS_FIELD_NUMBER: _ClassVar[int]
    PATCH_CUTS_FIELD_NUMBER: _ClassVar[int]
    DERIVATIVE_SEPARATIONS_FIELD_NUMBER: _ClassVar[int]
    DERIVATIVE_SUPPORTS_FIELD_NUMBER: _ClassVar[int]
    DERIVATIVE_CORNERS_FIELD_NUMBER: _ClassVar[int]
    supports: float
    gjk_iterations: float
    epa_iterations: float
    nodes: float
    pairs: float
    escalations: float
    patch_corners: float
    patch_cuts: float
    derivative_separations: float
    derivative_supports: float
    derivative_corners: float
    def __init__(self, supports: _Optional[float] = ..., gjk_iterations: _Optional[float] = ..., epa_iterations: _Optional[float] = ..., nodes: _Optional[float] = ..., pairs: _Optional[float] = ..., escalations: _Optional[float] = ..., patch_corners: _Optional[float] = ..., patch_cuts: _Optional[float] = ..., derivative_separations: _Optional[float] = ..., derivative_supports: _Optional[float] = ..., derivative_corners: _Optional[float] = ...) -> None: ...
